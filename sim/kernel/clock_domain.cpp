#include "sim/kernel/clock_domain.h"

#include <algorithm>
#include <numeric>

#include "model/error.h"
#include "sim/kernel/observer.h"
#include "sim/kernel/unit.h"

namespace splatscope::sim {

ClockDomain::ClockDomain(std::string name, Femtoseconds period, Femtoseconds reference, Scheduler scheduler)
    : name_(std::move(name)), period_(period), reference_(reference), scheduler_(scheduler) {}

void ClockDomain::add(Unit& unit, std::uint32_t number) {
  if (units_.size() >= 64 || number >= Books::kMostUnits) throw ModelError("more than 64 units");
  unit.domain_ = this;
  unit.place_ = static_cast<int>(units_.size());
  unit.number_ = number;
  units_.push_back(&unit);
  books_.emplace_back();
  later_.push_back(kNever);
  wake(unit.place_, 0);
}

Cycle ClockDomain::next_visited() const {
  if (scheduler_ == Scheduler::skip_ahead) return next();
  const bool pending =
      next() != kNever || std::any_of(peers_.begin(), peers_.end(),
                                      [](const ClockDomain* peer) { return peer->next() != kNever; });
  return pending ? now_ + 1 : kNever;
}

void ClockDomain::run(Cycle last) {
  limit_ = last;
  const Cycle first = next_visited();
  if (first != kNever && first > kMostTime / period_) {
    throw UserError("trace", 0,
                    "takes more than 5 hours of the machine's time, expected less: a run counts it in "
                    "femtoseconds, in 64 bits");
  }
  for (Cycle at = first; at <= limit_ && at != kNever; at = next_visited()) visit(at);
}

void ClockDomain::lower_limit(Femtoseconds time) {
  limit_ = std::min(limit_, time / period_);
}

void ClockDomain::visit(Cycle now) {
  std::uint64_t due = wheel_[now % kWheel];
  wheel_[now % kWheel] = 0;
  occupied_ &= ~(std::uint64_t{1} << (now % kWheel));
  now_ = now;
  if (earliest_later_ <= now) {
    earliest_later_ = kNever;
    for (std::size_t place = 0; place < later_.size(); ++place) {
      if (later_[place] <= now) {
        due |= std::uint64_t{1} << place;
        later_[place] = kNever;
      }
      earliest_later_ = std::min(earliest_later_, later_[place]);
    }
  }
  if (scheduler_ == Scheduler::referee) due = ~std::uint64_t{0} >> (64 - units_.size());
  if (now >= next_sample_) sample();
  call(due);
}

void ClockDomain::call(std::uint64_t due) {
  const Cycle at = reference_cycle(now_);
  for (; due != 0; due &= due - 1) {
    const int place = std::countr_zero(due);
    const auto index = static_cast<std::size_t>(place);
    const Step step = units_[index]->advance(now_);
    Books& books = books_[index];
    if (step.book != books.book) {
      if (!watches_.empty()) tell(index, at);
      books.enter(step.book, at);
    }
    if (step.next != kNever) wake(place, step.next > now_ ? step.next : now_ + 1);
  }
}

void ClockDomain::observe(Observer& observer) {
  watches_.push_back({&observer, 0});
  next_sample_ = 0;
}

void ClockDomain::tell(std::size_t place, Cycle until) const {
  const Books& books = books_[place];
  if (until <= books.since) return;
  for (const Watch& watch : watches_) watch.observer->booked(*units_[place], books.book, books.since, until);
}

void ClockDomain::sample() {
  next_sample_ = kNever;
  for (Watch& watch : watches_) {
    if (now_ >= watch.next_sample) {
      watch.next_sample = first_at(watch.observer->sample(reference_cycle(now_)));
    }
    next_sample_ = std::min(next_sample_, watch.next_sample);
  }
}

void ClockDomain::finish_observing(Cycle end) {
  for (std::size_t place = 0; place < units_.size(); ++place) tell(place, end);
}

Cycle ClockDomain::busy(std::size_t place, Cycle at) const {
  const Books& books = books_[place];
  const bool now = books.book == Step::kBusy && at > books.since;
  return books.cycles[Step::kBusy] + (now ? at - books.since : 0);
}

Books ClockDomain::closed_books(std::size_t place, Cycle end) const {
  Books books = books_[place];
  if (books.since > end) throw ModelError("unit " + units_[place]->name() + " acts after the end of the run");
  books.cycles[books.book] += end - books.since;
  if (std::accumulate(books.cycles.begin(), books.cycles.end(), Cycle{0}) != end) {
    throw ModelError("the books of unit " + units_[place]->name() + " do not add up");
  }
  return books;
}

}  // namespace splatscope::sim
