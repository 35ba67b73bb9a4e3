#include "studies/table1.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/isa/program.h"
#include "studies/reference_comparison.h"
#include "traces/weight_capture.h"

namespace splatscope::studies {
namespace {

// Ren 2002, Table 1: frames per second at 512 x 512.
struct Published {
  std::string_view algorithm;
  std::string_view machine;
  double fps;
};
constexpr Published kPublished[] = {
    {"no-ewa", "radeon-8500", 57.3},         {"no-ewa", "geforce4-ti4400", 59.6},
    {"ewa-per-pixel", "radeon-8500", 1.3},   {"ewa-per-pixel", "geforce4-ti4400", 1.0},
    {"ewa-per-surfel", "radeon-8500", 16.9}, {"ewa-per-surfel", "geforce4-ti4400", 23.8},
};

// The parameter fitted to a row, or nothing: machine files name the rows, as in "table1 ewa-per-pixel".
std::string fitted_parameter(const Machine& machine, std::string_view algorithm) {
  for (const auto& [parameter, origin] : machine.origins) {
    if (origin.fitted_to == fmt::format("table1 {}", algorithm)) return parameter;
  }
  return {};
}

void find_bottleneck(const sim::Result& timing, Table1Row& row) {
  const auto busiest = std::ranges::max_element(timing.units, {}, &sim::UnitBooks::busy);
  row.bottleneck = busiest->name;
  row.bottleneck_share = static_cast<double>(busiest->busy) / static_cast<double>(timing.cycles);
}

int slots_of(const Trace& trace, std::size_t program) {
  return isa::slot_count(isa::load(trace.programs[program].text, trace.programs[program].name));
}

// The two vertex programs of a recorded trace, in the order of its passes.
void count_slots(const Trace& trace, Table1Row& row) {
  std::vector<std::uint32_t> programs;
  for (const Command& command : trace.commands) {
    if (const auto* draw = std::get_if<Draw>(&command)) programs.push_back(draw->vertex_program);
  }
  row.visibility_slots = slots_of(trace, programs.front());
  row.splat_slots = slots_of(trace, programs.back());
}

}  // namespace

Table1 reproduce_table1(const Progress& progress) {
  Table1 table;
  const kernels::ReferencePicture reference =
      scene_reference(traces::load_scene("checkerboard-ewa-per-pixel"));
  std::map<std::string, traces::CapturedWeights, std::less<>>
      weights;  // by machine: two algorithms share them
  double done = 0;
  for (const Published& published : kPublished) {
    const auto step = [&](double fraction) {
      if (progress) progress((done + fraction) / std::size(kPublished));
    };
    const Machine machine = machine::load(published.machine);
    const traces::Scene scene = traces::load_scene(fmt::format("checkerboard-{}", published.algorithm));
    const bool per_pixel = scene.splatting.algorithm == traces::Algorithm::ewa_per_pixel;
    if (!per_pixel && !weights.contains(published.machine)) {
      weights.emplace(published.machine, traces::capture_weights(scene, machine.numbers));
    }
    const Trace trace = per_pixel ? traces::record(scene, machine.numbers).trace
                                  : traces::record(scene, weights.find(published.machine)->second).trace;
    const FrameRun run = run_frame(trace, machine, Fidelity::cycle, step);

    Table1Row row;
    row.algorithm = published.algorithm;
    row.machine = published.machine;
    row.published_fps = published.fps;
    row.simulated_fps = run.timing->frames_per_second();
    row.fitted_by = fitted_parameter(machine, published.algorithm);
    row.fitted = !row.fitted_by.empty();
    row.cycles_per_host_second = static_cast<double>(run.timing->cycles) / run.timing_seconds;
    row.psnr = psnr(run.rendered.frame, reference);
    count_slots(trace, row);
    find_bottleneck(*run.timing, row);
    table.rows.push_back(row);
    if (published.machine == "geforce4-ti4400") {
      table.pictures.push_back({row.algorithm, picture_of(run.rendered.frame)});
    }
    ++done;
  }
  return table;
}

std::string text_of(const Table1& table) {
  std::string out =
      fmt::format("{:<15} {:<16} {:>4} {:>4} {:>10} {:>10} {:>7}  {:<9} {:<18} {:>8}\n", "algorithm",
                  "machine", "VS1", "VS2", "published", "simulated", "error", "role", "bottleneck", "PSNR");
  for (const Table1Row& row : table.rows) {
    out += fmt::format(
        "{:<15} {:<16} {:>4} {:>4} {:>6.1f} fps {:>6.2f} fps {:>+6.1f}%  {:<9} {:<12} {:>3.0f} % {:>6.1f} "
        "dB\n",
        row.algorithm, row.machine, row.visibility_slots, row.splat_slots, row.published_fps,
        row.simulated_fps, 100 * row.error(), row.fitted ? "fitted" : "predicted", row.bottleneck,
        100 * row.bottleneck_share, row.psnr);
  }
  return out;
}

}  // namespace splatscope::studies
