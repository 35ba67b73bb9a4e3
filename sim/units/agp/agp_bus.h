#pragma once

#include <deque>
#include <vector>

#include "model/machine/machine.h"
#include "sim/units/memory/data_clocks.h"
#include "sim/units/memory/memory_port.h"

namespace splatscope::sim {

// The AGP bus reading host memory for the graphics core: one request after the other on the data lines,
// latencies overlapping. On the bus clock.
class AgpBus final : public Unit {
 public:
  AgpBus(std::string name, const Machine::Agp& spec, Femtoseconds period);
  void connect(MemoryPort& port, Channel<MemoryRequest>& requests) { clients_.push_back({&port, &requests}); }

  Step advance(Cycle now) override;
  std::vector<Statistic> statistics(Cycle now) const override;

 private:
  struct Client {
    MemoryPort* port;
    Channel<MemoryRequest>* requests;
  };
  struct Transfer {
    Cycle start, end;  // of a request's data
  };
  bool serve(Cycle now, const Client& client);
  bool is_full() const { return on_the_way_.size() == static_cast<std::size_t>(spec_.queue); }
  Step waiting(Cycle now) const;

  Machine::Agp spec_;
  Cycle latency_;
  std::vector<Client> clients_;
  std::size_t turn_ = 0;
  Cycle data_free_ = 0;
  std::deque<Transfer> on_the_way_;
  std::uint64_t reads_ = 0;
  DataClocks data_clocks_;
};

}  // namespace splatscope::sim
