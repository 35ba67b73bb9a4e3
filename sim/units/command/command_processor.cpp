#include "sim/units/command/command_processor.h"

#include <algorithm>
#include <utility>

namespace splatscope::sim {

CommandProcessor::CommandProcessor(std::string name, Completion& completion)
    : Unit(std::move(name)), completion_(completion) {
  completion_.set_waiter(*this);
}

void CommandProcessor::connect(Channel<Order>& from_host, Channel<std::uint32_t>& to_host, MemoryPort& port) {
  from_host_ = &from_host;
  to_host_ = &to_host;
  port_ = &port;
}

void CommandProcessor::set_draws(const std::vector<DrawJob>& jobs, std::vector<DrawUnit*> units) {
  jobs_ = &jobs;
  units_ = std::move(units);
}

void CommandProcessor::set_frame(DepthUnit* depth, bool fast_depth_clear, BlendUnit* blend,
                                 std::vector<Surface> cleared) {
  depth_ = depth;
  fast_depth_clear_ = fast_depth_clear;
  blend_ = blend;
  cleared_ = std::move(cleared);
}

void CommandProcessor::begin(Cycle now, const Order& order) {
  event(now, static_cast<std::uint64_t>(order.kind));
  phase_ = order.kind == OrderKind::clear ? Phase::filling : Phase::working;
  switch (order.kind) {
    case OrderKind::draw:
      if (prepare_) prepare_(order.job);
      // A surface that is sampled must be in memory.
      if ((*jobs_)[order.job].textured && (*jobs_)[order.job].draw->source) {
        after_flush_ = &(*jobs_)[order.job];
        return begin_flush(now);
      }
      return begin_draw(now, (*jobs_)[order.job]);
    case OrderKind::hand_over:
      hands_over_ = blend_ != nullptr;
      return begin_flush(now);
    case OrderKind::flush:
      return begin_flush(now);
    case OrderKind::clear:
      return begin_clear();
  }
}

void CommandProcessor::begin_draw(Cycle now, const DrawJob& job) {
  std::uint32_t working = 0;
  for (DrawUnit* unit : units_) {
    if (!unit->begin(job)) continue;
    ++working;
    unit->wake(now + 1);
  }
  completion_.start(now, working);
}

void CommandProcessor::begin_flush(Cycle now) {
  completion_.start(now, (depth_ ? 1u : 0u) + (blend_ ? 1u : 0u));
  if (depth_) {
    depth_->begin_flush();
    depth_->wake(now + 1);
  }
  if (blend_) {
    blend_->begin_flush();
    blend_->wake(now + 1);
  }
}

void CommandProcessor::begin_clear() {
  if (depth_) depth_->clear(fast_depth_clear_);
  if (blend_) blend_->clear();
  surface_ = 0;
  filled_ = 0;
}

// Writes as much of the surfaces as memory takes in a cycle. True: something went out.
bool CommandProcessor::fill(Cycle now) {
  bool moved = false;
  while (surface_ < cleared_.size()) {
    const Surface& surface = cleared_[surface_];
    if (filled_ >= surface.bytes) {
      ++surface_;
      filled_ = 0;
      continue;
    }
    if (port_->in_the_way(now, surface.address + filled_)) break;
    const std::uint32_t bytes = std::min(surface.bytes - filled_, port_->interleave());
    port_->write(now, surface.address + filled_, bytes);
    filled_ += bytes;
    bytes_filled_ += bytes;
    moved = true;
  }
  return moved;
}

Step CommandProcessor::advance(Cycle now) {
  if (phase_ == Phase::waiting) {
    if (!from_host_->can_pop(now)) return idle(from_host_->next_visible());
    begin(now, from_host_->pop(now));
    return busy(now + 1);
  }
  if (phase_ == Phase::filling) {
    if (fill(now)) return busy(now + 1);
    if (surface_ < cleared_.size()) {
      const std::uint32_t address = cleared_[surface_].address + filled_;
      return blocked(*port_->in_the_way(now, address), port_->next_free(address));
    }
    const Cycle written = port_->writes_done();
    if (written == kNever) port_->await_writes();
    if (written > now) return busy(written);
    phase_ = Phase::reporting;
  }
  if (phase_ == Phase::working) {
    if (completion_.done_at() > now) return idle(completion_.done_at());
    if (after_flush_) {
      begin_draw(now, *std::exchange(after_flush_, nullptr));
      return busy(now + 1);
    }
    if (std::exchange(hands_over_, false)) blend_->clear();
    phase_ = Phase::reporting;
  }
  if (!to_host_->can_push(now)) return blocked(to_host_->consumer(), to_host_->next_free());
  to_host_->push(now, orders_++);
  event(now, orders_);
  phase_ = Phase::waiting;
  return busy(now + 1);
}

std::vector<Statistic> CommandProcessor::statistics(Cycle) const {
  return {{"orders", "orders", "draws, clears and cache flushes", orders_},
          {"bytes_filled", "bytes", "written by clears", bytes_filled_}};
}

std::string CommandProcessor::state() const {
  static constexpr const char* kNames[] = {"waiting for the host", "waiting for the pipeline", "clearing",
                                           "reporting"};
  return kNames[static_cast<std::size_t>(phase_)];
}

}  // namespace splatscope::sim
