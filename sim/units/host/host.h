#pragma once

#include <vector>

#include "model/command/commands.h"
#include "model/machine/machine.h"
#include "sim/kernel/channel.h"
#include "sim/units/command/command_processor.h"

namespace splatscope::sim {

// The host: sends the commands of a trace one after the other, and normalises the frame itself: it reads each
// pixel over the bus with uncached reads and waits for every one, divides, and writes the pixel back (posted:
// the host waits only for the bus to take it). On the bus clock. Clears, draws and normalisations do not
// overlap.
class Host final : public Unit {
 public:
  // To read back, divide and write one pixel of so many bytes. `period`: of the bus clock.
  static Femtoseconds pixel_time(const Machine::Host& spec, Femtoseconds period, int pixel_bytes);

  // Of the frame.
  struct Pixels {
    std::uint64_t count = 0;
    int bytes = 4;  // of one
  };
  // `period`: of the bus clock.
  Host(std::string name, const Machine::Host& spec, Femtoseconds period, const Trace& trace,
       const Pixels& frame);
  void connect(Channel<Order>& orders, Channel<std::uint32_t>& reports);

  Step advance(Cycle now) override;
  std::vector<Statistic> statistics(Cycle) const override;
  std::string state() const override;

  bool is_finished() const { return phase_ == Phase::done; }
  Cycle finished_at() const { return finished_at_; }
  // Bus cycle at which each command was done; the last one includes writing the caches back, as a Present
  // does.
  const std::vector<Cycle>& command_ends() const { return ends_; }

 private:
  enum class Phase : std::uint8_t { preparing, sending, waiting, normalizing, done };

  void next_command(Cycle now);
  void prepare(Cycle now);
  Step send(Cycle now);
  Step report(Cycle now);
  Step finish(Cycle now);
  Step normalize(Cycle now);
  bool at_end() const { return command_ == trace_.commands.size(); }

  Machine::Host spec_;
  Femtoseconds period_;
  const Trace& trace_;
  Pixels frame_;
  Channel<Order>* orders_ = nullptr;
  Channel<std::uint32_t>* reports_ = nullptr;

  Phase phase_ = Phase::preparing;
  std::size_t command_ = 0;
  std::uint32_t draws_ = 0;
  Cycle ready_ = kNever;
  std::uint64_t pixels_left_ = 0;
  Femtoseconds pixel_end_ = 0;
  Cycle finished_at_ = 0;
  std::vector<Cycle> ends_;
  std::uint64_t pixels_ = 0;
};

}  // namespace splatscope::sim
