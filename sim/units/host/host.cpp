#include "sim/units/host/host.h"

#include <cmath>

namespace splatscope::sim {

Femtoseconds Host::pixel_time(const Machine::Host& spec, Femtoseconds period, int pixel_bytes) {
  // A pixel takes whole reads, or one read serves several pixels.
  const double part = static_cast<double>(pixel_bytes) / spec.uncached_read_bytes;
  const double reads = part < 1 ? part : std::ceil(part);
  const double nanoseconds = reads * spec.uncached_read_nanoseconds + spec.division_nanoseconds;
  const int writes = (pixel_bytes + spec.write_bytes_per_clock - 1) / spec.write_bytes_per_clock;
  return femtoseconds_of(nanoseconds) + static_cast<Femtoseconds>(writes) * period;
}

Host::Host(std::string name, const Machine::Host& spec, Femtoseconds period, const Trace& trace,
           const Pixels& frame)
    : Unit(std::move(name)), spec_(spec), period_(period), trace_(trace), frame_(frame) {}

void Host::connect(Channel<Order>& orders, Channel<std::uint32_t>& reports) {
  orders_ = &orders;
  reports_ = &reports;
}

// Before a frame is shown, and before the host reads it, the caches are written back.
Step Host::send(Cycle now) {
  if (!orders_->can_push(now)) return blocked(orders_->consumer(), orders_->next_free());
  Order order{OrderKind::flush, 0};
  if (!at_end()) {
    const Command& command = trace_.commands[command_];
    if (std::holds_alternative<Draw>(command)) order = {OrderKind::draw, draws_++};
    if (std::holds_alternative<Clear>(command)) order = {OrderKind::clear, 0};
    if (std::holds_alternative<NormalizeOnHost>(command)) order = {OrderKind::hand_over, 0};
  }
  orders_->push(now, order);
  event(now, static_cast<std::uint64_t>(order.kind));
  phase_ = Phase::waiting;
  return busy(now + 1);
}

Step Host::report(Cycle now) {
  if (!reports_->can_pop(now)) return idle(reports_->next_visible());
  reports_->pop(now);
  event(now, command_);
  if (at_end()) {
    if (!ends_.empty()) ends_.back() = now;
    return finish(now);
  }
  if (std::holds_alternative<NormalizeOnHost>(trace_.commands[command_])) {
    phase_ = Phase::normalizing;
    pixels_left_ = frame_.count;
    pixel_end_ = now * period_;
    ready_ = now;
    return busy(now + 1);
  }
  const bool shown = std::holds_alternative<Present>(trace_.commands[command_]);
  next_command(now);
  return shown && at_end() ? finish(now) : busy(ready_);
}

Step Host::finish(Cycle now) {
  finished_at_ = now;
  phase_ = Phase::done;
  return idle();
}

void Host::next_command(Cycle now) {
  ends_.push_back(now);
  ++command_;
  prepare(now);
}

void Host::prepare(Cycle now) {
  phase_ = Phase::preparing;
  ready_ = now + (at_end() ? 0 : cycles_of(femtoseconds_of(spec_.command_nanoseconds), period_));
}

Step Host::normalize(Cycle now) {
  if (ready_ > now) return busy(ready_);
  if (pixels_left_ == 0) {
    next_command(now);
    return busy(ready_);
  }
  --pixels_left_;
  ++pixels_;
  pixel_end_ += pixel_time(spec_, period_, frame_.bytes);
  ready_ = cycles_of(pixel_end_, period_);
  event(ready_, pixels_left_);
  return busy(ready_);
}

Step Host::advance(Cycle now) {
  switch (phase_) {
    case Phase::preparing:
      if (ready_ == kNever) prepare(now);
      if (ready_ > now) return busy(ready_);
      phase_ = Phase::sending;
      [[fallthrough]];
    case Phase::sending:
      return send(now);
    case Phase::waiting:
      return report(now);
    case Phase::normalizing:
      return normalize(now);
    case Phase::done:
      return idle();
  }
  return idle();
}

std::vector<Statistic> Host::statistics(Cycle) const {
  return {{"commands", "commands", "of the trace, done", ends_.size()},
          {"pixels_normalized", "pixels", "read back, divided and written", pixels_}};
}

std::string Host::state() const {
  return "command " + std::to_string(command_) + " of " + std::to_string(trace_.commands.size());
}

}  // namespace splatscope::sim
