#pragma once

#include <vector>

#include "model/machine/machine.h"
#include "sim/units/memory/data_clocks.h"
#include "sim/units/memory/memory_port.h"

namespace splatscope::sim {

// One channel of the memory controller with its DRAM: banks, rows, data bus.
class MemoryChannel final : public Unit {
 public:
  MemoryChannel(std::string name, const Machine::Memory& spec);

  // Adds a client; the channel is the client's request channel to this unit.
  void connect(MemoryPort& port, Channel<MemoryRequest>& requests);

  Step advance(Cycle now) override;
  std::vector<Statistic> statistics(Cycle now) const override;
  std::string state() const override;

 private:
  struct Client {
    MemoryPort* port;
    Channel<MemoryRequest>* requests;
    std::uint64_t name;  // in events: the same whatever other clients there are
  };
  struct Entry {
    std::uint32_t row;
    std::uint32_t slot;
    std::uint16_t bursts;
    std::uint8_t bank;
    std::uint8_t client;
    bool write;
  };
  struct Bank {
    std::uint64_t open_row = kNever;  // kNever: none
    Cycle access_from = 0;            // the next column access
    Cycle precharge_from = 0;
  };

  Entry entry_of(const MemoryRequest& request, std::size_t client) const;
  bool is_full() const { return queue_.size() >= static_cast<std::size_t>(spec_.schedule_queue); }
  Cycle accept(Cycle now);  // when the next can be
  std::size_t pick(Cycle now) const;
  void issue(Cycle now, std::size_t index);
  Cycle earliest_data(Cycle now, const Entry& entry) const;
  void open_row(Cycle now, const Entry& entry);

  Machine::Memory spec_;
  Cycle burst_clocks_, precharge_, activate_, cas_, row_active_, write_recovery_, turnaround_;
  std::uint32_t interleave_shift_, row_shift_, channel_shift_, bank_shift_, burst_shift_;
  std::vector<Client> clients_;
  std::size_t turn_ = 0;
  std::vector<Entry> queue_;  // oldest first
  std::vector<Bank> banks_;
  int bypassed_ = 0;  // times the oldest was overtaken
  bool last_was_write_ = false;
  Cycle next_issue_ = 0;
  Cycle bus_free_ = 0;
  std::uint64_t reads_ = 0, writes_ = 0, row_hits_ = 0, row_misses_ = 0;
  DataClocks data_clocks_;
};

}  // namespace splatscope::sim
