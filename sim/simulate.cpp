#include "sim/simulate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <limits>
#include <utility>

#include "sim/work_window.h"

namespace splatscope::sim {
namespace {

void add_unit(Result& result, const SimulatedMachine& machine, const Unit& unit, const Books& books) {
  result.units.push_back(named_books(machine, unit, books));
  std::ranges::move(named_statistics(unit), std::back_inserter(result.statistics));
  if (!unit.had_events()) return;  // the same hash, whether it is there or not
  result.event_hash = (std::rotl(result.event_hash, 7) ^ unit.event_hash()) * 0x9e3779b97f4a7c15u;
}

void report_progress(const SimulatedMachine& machine, const std::function<void(double)>& progress) {
  double triangles = 0;
  for (const DrawJob& job : machine.jobs) triangles += job.draw->index_count / 3;
  machine.assembly->on_progress(
      [triangles, &progress](std::uint64_t done) { progress(static_cast<double>(done) / triangles); });
}

Result run(SimulatedMachine& machine, const Trace& trace, const std::function<void(double)>& progress,
           std::span<Observer* const> observers) {
  const std::array<ClockDomain*, 2> domains{&machine.core, &machine.bus};
  if (progress) report_progress(machine, progress);
  for (Observer* observer : observers) {
    observer->begin(machine);
    for (ClockDomain* domain : domains) domain->observe(*observer);
  }
  machine.run();

  Result result;
  result.cycles = machine.cycles();
  result.seconds = seconds_of(result.cycles, machine.core.time(1));
  for (ClockDomain* domain : domains) {
    domain->finish_observing(result.cycles);
    for (std::size_t place = 0; place < domain->units().size(); ++place) {
      add_unit(result, machine, *domain->units()[place], domain->closed_books(place, result.cycles));
    }
  }
  for (const auto& channel : machine.channels) {
    result.channels.push_back({channel->producer().name(), channel->consumer().name(), channel->popped()});
  }
  for (const Cycle end : machine.host->command_ends()) {
    result.command_ends.push_back(machine.core_cycle(end));
  }
  result.frame_cycles = cycles_of_frames(trace, result);
  result.units_left_out = left_out(trace, machine.built, machine.jobs);
  for (Observer* observer : observers) observer->end(result);
  if (progress) progress(1);
  return result;
}

}  // namespace

Result::Bottleneck Result::bottleneck() const {
  const auto is_vertex_unit = [](const UnitBooks& unit) {
    return unit.name.starts_with("vertex") && unit.name.back() >= '0' && unit.name.back() <= '9';
  };
  Cycle all_vertex_units = kNever;
  std::size_t vertex_units = 0;
  for (const UnitBooks& unit : units) {
    if (!is_vertex_unit(unit)) continue;
    all_vertex_units = std::min(all_vertex_units, unit.busy);
    ++vertex_units;
  }
  const auto counted = [&](const UnitBooks& unit) {
    return is_vertex_unit(unit) ? all_vertex_units : unit.busy;
  };
  const UnitBooks& busiest = *std::ranges::max_element(
      units, {}, [&](const UnitBooks& unit) { return std::pair(counted(unit), unit.busy); });
  return {busiest.name, counted(busiest), is_vertex_unit(busiest) ? vertex_units : 0};
}

UnitBooks named_books(const SimulatedMachine& machine, const Unit& unit, const Books& books) {
  UnitBooks entry;
  entry.name = unit.name();
  entry.busy = books.cycles[Step::kBusy];
  entry.starved = books.cycles[Step::kStarved];
  entry.idle = books.cycles[Step::kIdle];
  for (const auto& by : machine.units) {
    const Cycle cycles = books.cycles[Step::kBlocked + by->number()];
    if (cycles == 0) continue;
    entry.blocked += cycles;
    entry.blocked_by.emplace_back(by->name(), cycles);
  }
  return entry;
}

std::vector<UnitStatistic> named_statistics(const Unit& unit) {
  std::vector<UnitStatistic> list;
  for (const Statistic& statistic : unit.statistics(kNever)) {
    list.push_back({unit.name(), std::string(statistic.name), std::string(statistic.unit),
                    std::string(statistic.what), statistic.value});
  }
  return list;
}

std::vector<Cycle> cycles_of_frames(const Trace& trace, const Result& result) {
  std::vector<Cycle> cycles;
  Cycle start = 0;
  for (const std::size_t end : frame_ends(trace)) {
    const Cycle done = end == trace.commands.size() ? result.cycles : result.command_ends[end - 1];
    cycles.push_back(done - start);
    start = done;
  }
  return cycles;
}

Result simulate(const Trace& trace, std::span<const DrawWork> work, const Machine& spec, Scheduler scheduler,
                const std::function<void(double)>& progress, std::span<Observer* const> observers,
                UnitChoice choice) {
  const MemoryLayout layout = lay_out(trace, spec);
  const auto machine =
      build_machine(trace, prepare_draws(trace, work, spec, layout), layout, spec, scheduler, choice);
  return run(*machine, trace, progress, observers);
}

Result simulate_beside(const Trace& trace, const PartSource& next_part, const Machine& spec,
                       Scheduler scheduler, const std::function<void(double)>& progress,
                       std::span<Observer* const> observers) {
  const MemoryLayout layout = lay_out(trace, spec);
  const auto machine = build_machine(trace, prepare_draws(trace, spec, layout), layout, spec, scheduler);
  WorkParts parts(next_part, machine->of_draws);
  machine->command->on_draw([&](std::uint32_t draw) { parts.begin(machine->jobs[draw]); });
  return run(*machine, trace, progress, observers);
}

}  // namespace splatscope::sim
