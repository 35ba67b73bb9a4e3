#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "model/error.h"
#include "sim/kernel/channel.h"
#include "sim/units/draw_job.h"

namespace splatscope::sim {

// From unit to unit: numbers of the draw's triangles, or of its quads.
using Items = Channel<std::uint32_t>;

// When the last unit has done its last item of a command. Finished at t is seen at t + 1.
class Completion {
 public:
  void set_waiter(Unit& waiter) { waiter_ = &waiter; }
  void start(Cycle now, std::uint32_t units) {
    outstanding_ = units;
    last_ = now;
    done_at_ = units == 0 ? now + 1 : kNever;
  }
  // `last`: the cycle in which a unit does the last of its work, this one or a later one.
  void finish(Cycle last) {
    last_ = std::max(last_, last);
    if (--outstanding_ == 0) {
      done_at_ = last_ + 1;
      waiter_->wake(done_at_);
    }
  }
  Cycle done_at() const { return done_at_; }

 private:
  Unit* waiter_ = nullptr;
  std::uint32_t outstanding_ = 0;
  Cycle last_ = 0;
  Cycle done_at_ = kNever;
};

// A unit that works on draws. The command processor, called last in a cycle, begins a draw; its items are
// counted down to tell *idle* (nothing left of this draw) from *starved* (some are still to come).
class DrawUnit : public Unit {
 public:
  DrawUnit(std::string name, Completion& completion) : Unit(std::move(name)), completion_(completion) {}

  // Whether the unit has items to do of this draw; they are seen from the next cycle on.
  bool begin(const DrawJob& job) {
    job_ = &job;
    next_cut_ = 0;
    known_ = remaining_ = 0;
    start(job);
    look_for_items();
    return has_work();
  }
  // How many items the unit has to do of what there is of a draw, and how many of these it has done. It looks
  // no more at the records of what it has done.
  virtual std::uint64_t items(const DrawJob& job) const = 0;
  // False: none, whatever comes.
  virtual bool takes_part(const DrawJob&) const { return true; }
  // How many cuts of a draw it will not look at again.
  static constexpr std::uint64_t kNoMoreCuts = ~std::uint64_t{0};
  virtual std::uint64_t cuts_passed(const DrawJob&) const { return kNoMoreCuts; }
  std::uint64_t items_done(const DrawJob& job) const { return job_ == &job ? known_ - remaining_ : 0; }

 protected:
  virtual void start(const DrawJob&) {}

  const DrawJob& job() const { return *job_; }
  bool has_work() const { return remaining_ != 0; }
  // `last`: the last cycle that the item takes of the unit, this one or a later one.
  void item_done(Cycle last) {
    if (remaining_ == 0) throw ModelError(name() + " has an item of no draw that it has begun");
    if (--remaining_ != 0) return;
    look_for_items();
    if (remaining_ == 0) completion_.finish(last);
  }
  // Before item `number` is taken: pass(cut) for each cut before it that was not met yet. `first_after`:
  // which of the items a cut is told by.
  template <typename Pass>
  void pass_cuts(std::uint32_t Cut::*first_after, std::size_t number, Pass pass) {
    const Cuts* cuts = job_->cuts;
    if (cuts == nullptr) return;
    for (; next_cut_ < cuts->end(); ++next_cut_) {
      if (next_cut_ < cuts->begin())
        throw ModelError(name() + " meets cuts, and does not say so (cuts_passed)");
      if ((*cuts)[next_cut_].*first_after > number) return;
      pass((*cuts)[next_cut_]);
    }
  }
  // cuts_passed() of a unit that calls pass_cuts().
  std::uint64_t cuts_passed_by_tags(const DrawJob& job) const {
    if (!takes_part(job)) return kNoMoreCuts;
    return job_ == &job ? next_cut_ : 0;
  }
  Step nothing_to_take(Cycle next) const { return has_work() ? starved(next) : idle(next); }
  Completion& completion() { return completion_; }

 private:
  // Of the work that has come, until there is an item or none is to come: so how it is cut into parts changes
  // nothing.
  void look_for_items() {
    for (;;) {
      const std::uint64_t all = items(*job_);
      remaining_ += all - known_;
      known_ = all;
      if (remaining_ != 0 || job_->is_complete() || !takes_part(*job_)) return;
      job_->rest->take();
    }
  }

  Completion& completion_;
  const DrawJob* job_ = nullptr;
  std::uint64_t known_ = 0;      // items of what there was of the draw when it was last looked at
  std::uint64_t remaining_ = 0;  // of these
  std::uint64_t next_cut_ = 0;   // of the draw
};

}  // namespace splatscope::sim
