#include "studies/fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "studies/frame_cost.h"
#include "studies/measure.h"
#include "studies/reproduction/depth_offset.h"
#include "studies/reproduction/figure10.h"
#include "studies/reproduction/figure3.h"
#include "studies/reproduction/table2.h"
#include "traces/framing.h"

namespace splatscope::studies {
namespace {

constexpr std::string_view kTable1[] = {"checkerboard-no-ewa", "checkerboard-ewa-per-pixel",
                                        "checkerboard-ewa-per-surfel"};

double plus_minus_of(const sim::Result& timing, std::size_t frame) {
  return timing.frame_plus_minus.empty() ? 0 : timing.frame_plus_minus[frame];
}

// One of each of the `frames` of a trace. Their seconds, and the books of units, are known of all together.
std::vector<FidelityRow> rows_by_frame(const FidelityFrame& frame, std::string_view machine,
                                       Fidelity fidelity, const FrameCost& cost, std::size_t frames) {
  FidelityRow row;
  row.resolution = frame.resolution;
  row.machine = machine;
  row.fidelity = fidelity;
  row.host_seconds = cost.seconds / static_cast<double>(frames);
  row.peak_megabytes = cost.megabytes;
  if (cost.timing) {
    for (const sim::UnitBooks& books : cost.timing->units)
      row.units.push_back(
          {books.name, static_cast<double>(books.busy) / static_cast<double>(cost.timing->cycles)});
  }
  std::vector<FidelityRow> rows(frames, row);
  for (std::size_t i = 0; i < frames; ++i) {
    rows[i].scene = frames == 1 ? frame.scene : fmt::format("{}, frame {}", frame.scene, i + 1);
    if (!cost.timing) continue;
    rows[i].cycles = cost.timing->frame_cycles[i];
    rows[i].cycles_plus_minus = plus_minus_of(*cost.timing, i);
  }
  return rows;
}

std::vector<DrawWork> work_of(const Trace& trace, const Machine& machine) {
  return render(trace, render_options(machine)).work;
}

// What other samples say of each frame of a trace: of one that is simulated whole once.
void add_seeds(const Trace& trace, const Machine& machine, std::vector<FidelityRow>& rows) {
  const std::vector<DrawWork> work = work_of(trace, machine);
  for (std::uint64_t seed = 0; seed < kSampleSeeds; ++seed) {
    const sim::Result result =
        time_frame(trace, work, machine, Fidelity::sampled, {.seed = seed, .heat_maps = nullptr});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double plus_minus = plus_minus_of(result, i);
      if (seed == 0 || plus_minus > 0)
        rows[i].seeds.push_back({static_cast<double>(result.frame_cycles[i]), plus_minus});
    }
  }
}

// Utilisations become errors.
void compare_with(const FidelityRow& referee, FidelityRow& row) {
  if (row.cycles == 0) return;
  const auto cycles = static_cast<double>(referee.cycles);
  row.error = static_cast<double>(row.cycles) / cycles - 1;
  for (FidelityRow::Seed& seed : row.seeds) seed.error = seed.cycles / cycles - 1;
  for (std::size_t i = 0; i < row.units.size(); ++i) row.units[i].error -= referee.units[i].error;
}

// Host seconds of the timing alone.
struct Saving {
  double needed = 0, all = 0;  // units
  double share() const { return 1 - needed / all; }
};

// Adds what the time of a frame takes with the units that it needs and with every unit, one right after the
// other, each the least of `repetitions`.
void add_saving(const Trace& trace, const Machine& machine, sim::Scheduler scheduler, int repetitions,
                Saving& saving) {
  const std::vector<DrawWork> work = work_of(trace, machine);
  constexpr double kMost = std::numeric_limits<double>::max();
  double needed = kMost, all = kMost;
  for (int i = 0; i < repetitions; ++i) {
    for (const auto& [choice, least] :
         {std::pair(sim::UnitChoice::needed, &needed), {sim::UnitChoice::all, &all}}) {
      const auto start = HostClock::now();
      sim::simulate(trace, work, machine, scheduler, {}, {}, choice);
      *least = std::min(*least, seconds_since(start));
    }
  }
  saving.needed += needed;
  saving.all += all;
}

void study_saving(Findings& findings, const Progress& progress) {
  Saving cycle, referee;
  std::size_t done = 0;
  for (const std::string_view ready : kTable1) {
    for (const std::string_view name : kBothMachines) {
      const Machine machine = machine::load(name);
      const Trace trace = traces::record(traces::load_scene(ready), machine.numbers).trace;
      add_saving(trace, machine, sim::Scheduler::skip_ahead, kFidelityRepetitions, cycle);
      // One frame is enough: it takes a minute.
      if (ready == kTable1[2] && name == kBothMachines[0])
        add_saving(trace, machine, sim::Scheduler::referee, kFidelityRepetitions, referee);
      tell(progress, ++done, std::size(kTable1) * std::size(kBothMachines));
    }
  }
  findings.text(
      fmt::format("leaving out the units that no draw uses saves of the time of the timing\n"
                  "cycle       {:>10.1f} %  Table 1\n"
                  "referee     {:>10.1f} %  {} on {}\n",
                  100 * cycle.share(), 100 * referee.share(), kTable1[2], kBothMachines[0]));
  findings.result("units_left_out", {{"cycle_saving", cycle.share()}, {"referee_saving", referee.share()}});
}

std::vector<FidelityRow> rows_of(std::span<const FidelityFrame> frames, const Progress& progress) {
  const auto all = static_cast<double>(frames.size());
  std::vector<FidelityRow> rows;
  double done = 0;
  for (const FidelityFrame& frame : frames) {
    const auto more =
        fidelity_rows(frame, kFidelityRepetitions, part(progress, done / all, (done + 1) / all));
    rows.insert(rows.end(), more.begin(), more.end());
    ++done;
  }
  return rows;
}

std::vector<FidelityFrame> table1_frames() {
  std::vector<FidelityFrame> frames;
  for (const std::string_view ready : kTable1) frames.push_back(frame_of(traces::load_scene(ready)));
  return frames;
}

std::vector<FidelityRow> all_table2_rows(const Progress& progress) {
  std::size_t points = 0;
  for (const Table2Model& model : table2_models()) points += 2 * model.points;
  std::vector<FidelityRow> rows;
  double done = 0;
  for (const Table2Model& model : table2_models()) {
    traces::Scene scene = table2_scene(model);
    scene.name = model.name;
    for (const auto& published : model.published) {
      scene.frame.width = scene.frame.height = published.resolution;
      traces::place_planes(scene);
      const double next = done + static_cast<double>(model.points) / static_cast<double>(points);
      const FidelityFrame drawn{scene.name, published.resolution, [scene](const Machine& machine) {
                                  traces::Scene on_card = scene;
                                  on_card.splatting.video_megabytes = free_video_memory(machine.name);
                                  return traces::record(on_card, machine.numbers).trace;
                                }};
      const auto frame = fidelity_rows(drawn, kFidelityRepetitions, part(progress, done, next));
      rows.insert(rows.end(), frame.begin(), frame.end());
      done = next;
    }
  }
  return rows;
}

// Weights are captured from one view only: they say nothing of the time.
FidelityFrame named(std::string_view name, traces::Scene scene) {
  scene.name = name;
  scene.capture.views = 1;
  return frame_of(std::move(scene));
}

// With the paper's quads.
FidelityFrame depth_frame(std::string_view name, const traces::Scene& scene) {
  return {std::string(name), scene.frame.width,
          [trace = depth_trace(scene, 2)](const Machine&) { return trace; }};
}

FidelityFrame offset_frame(std::string_view name, const traces::Scene& scene) {
  return named(name,
               with_offset(scene, traces::DepthOffsetScheme::viewing_ray, scene.splatting.depth_offset));
}

// From coarse to fine (Ren 2002, 6.2): frames that are not alike.
std::vector<FidelityFrame> progressive_frames() {
  return {named(
      "progressive",
      traces::parse_scene(
          "surfels.generator = \"sphere\"\nsurfels.count = 50000\nframe.width = 256\nframe.height = 256\n"
          "hierarchy.culling = \"blocks\"\nhierarchy.progressive = true\n",
          "progressive"))};
}

}  // namespace

FidelityFrame frame_of(traces::Scene scene) {
  std::string name = scene.name;
  const int resolution = scene.frame.width;
  return {std::move(name), resolution, [scene = std::move(scene)](const Machine& machine) {
            return traces::record(scene, machine.numbers).trace;
          }};
}

std::vector<FidelityFrame> figure_frames() {
  const Figure3Scenes depth = figure3_scenes();
  return {depth_frame("fig3-even", depth.even),   depth_frame("fig3-uneven", depth.uneven),
          offset_frame("fig4", figure4_scene()),  offset_frame("fig5", figure5_scene()),
          named("fig10-model", figure10_model()), named("fig10-sheet", figure10_sheet())};
}

std::vector<FidelityRow> fidelity_rows(const FidelityFrame& frame, int repetitions,
                                       const Progress& progress) {
  std::vector<FidelityRow> rows;
  for (const std::string_view machine_name : kBothMachines) {
    const Machine machine = machine::load(machine_name);
    const Trace trace = frame.record(machine);
    const std::size_t first = rows.size(), frames = frame_ends(trace).size();
    for (const Fidelity fidelity : kFidelityLadder) {
      const int runs = fidelity == Fidelity::referee ? 1 : repetitions;
      auto more =
          rows_by_frame(frame, machine_name, fidelity, cost_of(trace, machine, fidelity, runs), frames);
      if (fidelity == Fidelity::sampled) add_seeds(trace, machine, more);
      rows.insert(rows.end(), more.begin(), more.end());
      tell(progress, rows.size(), std::size(kBothMachines) * std::size(kFidelityLadder) * frames);
    }
    const std::vector<FidelityRow> referee(rows.end() - static_cast<std::ptrdiff_t>(frames), rows.end());
    for (std::size_t i = first; i < rows.size(); ++i) compare_with(referee[(i - first) % frames], rows[i]);
  }
  return rows;
}

void study_fidelity(Findings& findings, const Progress& progress) {
  std::vector<FidelityGroup> groups;
  const auto add = [&](std::string_view name, std::vector<FidelityRow> rows) {
    groups.push_back({name, std::move(rows)});
    findings.say(fidelity_text(groups.back()));
  };
  add("Table 1", rows_of(table1_frames(), part(progress, 0, 0.2)));
  add("Table 2", all_table2_rows(part(progress, 0.2, 0.8)));
  add("Figures", rows_of(figure_frames(), part(progress, 0.8, 0.9)));
  add("Progressive", rows_of(progressive_frames(), part(progress, 0.9, 0.95)));
  add_fidelity_report(findings, groups);
  study_saving(findings, part(progress, 0.95, 1));
}

}  // namespace splatscope::studies
