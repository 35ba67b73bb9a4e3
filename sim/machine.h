#pragma once

#include <memory>
#include <vector>

#include "model/command/commands.h"
#include "model/machine/machine.h"
#include "model/work/work.h"
#include "sim/draw_jobs.h"
#include "sim/kernel/channel.h"
#include "sim/kernel/clock_domain.h"
#include "sim/units/command/command_processor.h"
#include "sim/units/host/host.h"
#include "sim/units/primitive/primitive_assembly.h"
#include "sim/units/vertex/vertex_unit.h"

namespace splatscope::sim {

// The simulated machine for one trace: its units, what connects them, and the draws made ready for them.
// Two clock domains: *core* (vertex to blending, and the memory, which both machines run at the core's
// clock), and *bus* (host and AGP).
struct SimulatedMachine {
  SimulatedMachine(const Machine& machine, Scheduler scheduler);
  SimulatedMachine(const SimulatedMachine&) = delete;
  SimulatedMachine& operator=(const SimulatedMachine&) = delete;

  ClockDomain core;
  ClockDomain bus;
  Completion completion;
  std::vector<std::vector<IssueSlot>> vertex_programs;
  std::vector<DrawJob> jobs;
  std::vector<std::unique_ptr<Unit>> units;  // in the order in which they are called, core before bus
  std::vector<std::unique_ptr<ChannelState>> channels;
  std::vector<std::unique_ptr<MemoryPort>> ports;
  Needs built;                            // what there is of the units that a trace may do without
  std::vector<const Unit*> memory;        // of the units: the memory channels
  std::vector<const DrawUnit*> of_draws;  // and those that count a draw's items by its records
  Host* host = nullptr;
  PrimitiveAssembly* assembly = nullptr;
  CommandProcessor* command = nullptr;

  // Runs the trace. ModelError for a deadlock, with what every unit and channel holds.
  void run();
  // After the run: the first core edge at or after a bus cycle, and the whole run's cycles.
  Cycle core_cycle(Cycle bus_cycle) const;
  Cycle cycles() const { return core_cycle(host->finished_at()); }
};

// Which units are created.
enum class UnitChoice : std::uint8_t {
  needed,  // by a draw of the trace
  all      // of the machine: slower, and the same cycles
};

// UserError where the host alone needs longer for `trace` than a run can take (kMostTime): what is known
// before anything is drawn.
void expect_countable_time(const Trace& trace, const Machine& machine);

// Creates the units and connects them. `draws`: of the trace. Throws what expect_countable_time does.
std::unique_ptr<SimulatedMachine> build_machine(const Trace& trace, PreparedDraws draws,
                                                const MemoryLayout& layout, const Machine& machine,
                                                Scheduler scheduler, UnitChoice choice = UnitChoice::needed);

}  // namespace splatscope::sim
