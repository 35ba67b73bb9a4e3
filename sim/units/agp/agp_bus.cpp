#include "sim/units/agp/agp_bus.h"

#include <algorithm>

namespace splatscope::sim {

AgpBus::AgpBus(std::string name, const Machine::Agp& spec, Femtoseconds period)
    : Unit(std::move(name)),
      spec_(spec),
      latency_(cycles_of(femtoseconds_of(spec.latency_nanoseconds), period)) {}

bool AgpBus::serve(Cycle now, const Client& client) {
  if (!client.requests->can_pop(now)) return false;
  const MemoryRequest request = client.requests->pop(now);
  const auto rate = static_cast<std::uint32_t>(spec_.bytes_per_clock);
  const Cycle length = (request.bytes + rate - 1) / rate;
  data_free_ = std::max(now + latency_, data_free_) + length;
  on_the_way_.push_back({data_free_ - length, data_free_});
  ++reads_;
  data_clocks_.book(now, data_free_ - length, data_free_);
  event(now, data_free_);
  // The core sees the data at its first edge after the last transfer.
  ClockDomain& core = client.port->client().domain();
  const Cycle at = core.first_after(domain().time(data_free_));
  domain().lower_limit(core.time(at));
  client.port->answer(request.slot, at);
  return true;
}

// Latencies overlap, so a bus that only waits for one could take more: it is starved. Data on the lines, or
// as many requests on the way as there may be, keep it busy.
Step AgpBus::waiting(Cycle now) const {
  Cycle next = kNever;
  if (!is_full())
    for (const Client& client : clients_) next = std::min(next, client.requests->next_visible());
  if (on_the_way_.empty()) return idle(next);
  const auto [start, end] = on_the_way_.front();
  if (is_full() || start <= now) return busy(std::min(next, end));
  return starved(std::min(next, start));
}

// One request a clock, the clients in turn.
Step AgpBus::advance(Cycle now) {
  while (!on_the_way_.empty() && on_the_way_.front().end <= now) on_the_way_.pop_front();
  for (std::size_t i = 0; i < clients_.size() && !is_full(); ++i) {
    const std::size_t client = (turn_ + i) % clients_.size();
    if (!serve(now, clients_[client])) continue;
    turn_ = (client + 1) % clients_.size();
    return busy(now + 1);
  }
  return waiting(now);
}

std::vector<Statistic> AgpBus::statistics(Cycle now) const {
  return {{"reads", "requests", "of host memory", reads_},
          {"data_clocks", "bus clocks", "in which the bus carried data", data_clocks_.until(now)}};
}

}  // namespace splatscope::sim
