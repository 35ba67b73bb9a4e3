#include "studies/reproduction/table1.h"

#include <fmt/format.h>

#include <string_view>

#include "studies/reference_comparison.h"
#include "studies/report/block_diagram.h"
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
    {"no-ewa", machine::kRadeon8500, 57.3},         {"no-ewa", machine::kGeForce4, 59.6},
    {"ewa-per-pixel", machine::kRadeon8500, 1.3},   {"ewa-per-pixel", machine::kGeForce4, 1.0},
    {"ewa-per-surfel", machine::kRadeon8500, 16.9}, {"ewa-per-surfel", machine::kGeForce4, 23.8},
};

// The parameter fitted to a row, or nothing: machine files name the rows, as in "table1 ewa-per-surfel,
// no-ewa".
std::string fitted_parameter(const Machine& machine, std::string_view algorithm) {
  for (const auto& [parameter, origin] : machine.origins) {
    if (origin.fitted_to.starts_with("table1 ") && origin.fitted_to.find(algorithm) != std::string::npos)
      return parameter;
  }
  return {};
}

// The two vertex programs of a recorded trace, in the order of its passes.
void count_slots(const Trace& trace, Table1Row& row) {
  std::vector<std::uint32_t> programs;
  for (const Command& command : trace.commands) {
    if (const auto* draw = std::get_if<Draw>(&command)) programs.push_back(draw->vertex_program);
  }
  row.visibility_slots = slots_of(trace.programs[programs.front()]);
  row.splat_slots = slots_of(trace.programs[programs.back()]);
}

nlohmann::ordered_json json_of(const std::vector<Table1Row>& table) {
  auto rows = nlohmann::ordered_json::array();
  for (const Table1Row& row : table) {
    rows.push_back({{"algorithm", row.algorithm},
                    {"machine", row.machine},
                    {"vs1", row.visibility_slots},
                    {"vs2", row.splat_slots},
                    {"fps_published", row.published_fps},
                    {"fps_simulated", row.simulated.fps},
                    {"error", row.error()},
                    {"role", row.fitted() ? "fitted" : "predicted"},
                    {"fitted_parameter", row.fitted_by},
                    {"bottleneck", row.simulated.bottleneck},
                    {"bottleneck_busy_share", row.simulated.share},
                    {"psnr_decibels", row.psnr},
                    {"cycles_per_host_second", row.cycles_per_host_second}});
  }
  return rows;
}

void add_to(Findings& findings, const std::vector<Table1Row>& table) {
  using enum Report::Align;
  Report& report = findings.report();
  report.heading("Table 1: frame rates at 512 x 512");
  std::vector<std::vector<std::string>> rows;
  for (const Table1Row& row : table) {
    rows.push_back({row.algorithm, row.machine, fmt::format("{}", row.visibility_slots),
                    fmt::format("{}", row.splat_slots), fmt::format("{:.1f}", row.published_fps),
                    fmt::format("{:.2f}", row.simulated.fps), fmt::format("{:+.1f} %", 100 * row.error()),
                    text_of_bottleneck(row.simulated), fmt::format("{:.1f}", row.psnr),
                    row.fitted() ? "fitted: " + row.fitted_by : "predicted"});
  }
  findings.table(
      "64k-surfel checkerboard plane. VS1, VS2: instruction slots of the two passes, counted from the "
      "programs that ran. A row is fitted where a parameter of the machine was fitted to that very figure, "
      "or chosen by it, else predicted.",
      {{"algorithm"},
       {"machine"},
       {"VS1", number},
       {"VS2", number},
       {"published fps", number},
       {"simulated fps", number},
       {"error", number},
       {"bottleneck"},
       {"PSNR, dB", number},
       {"role"}},
      rows);
  report.paragraph(
      "PSNR is against the double-precision sums of Eq. 8 by the exact map (perspective), normalised per "
      "pixel, over the pixels that the plane covers. The paper gives neither the camera nor the size of the "
      "squares: both are a reconstruction, as are the programs, of which it prints no listing.");
  for (const Table1Row& row : table) {
    if (row.algorithm != "ewa-per-surfel") continue;
    report.heading(fmt::format("Inside the {}: {}", row.machine, row.algorithm));
    add_machine(report, "Where the cycles of each unit went, and what went between the units.", row.timing);
  }
}

}  // namespace

std::vector<Table1Row> table1_rows(const Progress& progress) {
  std::vector<Table1Row> rows;
  const kernels::SplatSums reference =
      single_surface_reference(traces::load_scene("checkerboard-ewa-per-pixel"));
  std::map<std::string, traces::CapturedWeights, std::less<>>
      weights;  // by machine: two algorithms share them
  constexpr double kFrames = std::size(kPublished);
  double done = 0;
  for (const Published& published : kPublished) {
    const Machine machine = machine::load(published.machine);
    const traces::Scene scene = traces::load_scene(fmt::format("checkerboard-{}", published.algorithm));
    const bool per_pixel = scene.splatting.algorithm == traces::Algorithm::ewa_per_pixel;
    if (!per_pixel && !weights.contains(published.machine)) {
      weights.emplace(published.machine, traces::capture_weights(scene, machine.numbers));
    }
    const Trace trace = per_pixel ? traces::record(scene, machine.numbers).trace
                                  : traces::record(scene, weights.find(published.machine)->second).trace;
    const FrameRun run =
        run_frame(trace, machine, Fidelity::cycle, part(progress, done / kFrames, (done + 1) / kFrames));

    Table1Row row;
    row.algorithm = published.algorithm;
    row.machine = published.machine;
    row.published_fps = published.fps;
    row.simulated = rate_of(*run.timing);
    row.fitted_by = fitted_parameter(machine, published.algorithm);
    row.cycles_per_host_second = static_cast<double>(run.timing->cycles) / run.host_seconds;
    row.psnr = psnr(run.rendered.frame, reference);
    count_slots(trace, row);
    row.timing = *run.timing;
    rows.push_back(std::move(row));
    ++done;
  }
  return rows;
}

void reproduce_table1(Findings& findings, const Progress& progress) {
  const std::vector<Table1Row> rows = table1_rows(progress);
  findings.result("table1", json_of(rows));
  add_to(findings, rows);
}

}  // namespace splatscope::studies
