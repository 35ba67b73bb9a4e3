#include "studies/vertex_data.h"

#include <fmt/format.h>

#include <optional>

#include "kernels/object_space_ewa/programs.h"
#include "kernels/splat_programs.h"
#include "traces/weight_capture.h"

namespace splatscope::studies {
namespace {

// From most instructions to least.
constexpr ProgramPair kPairs[] = {{"quad", "paper"},    {"corner", "paper"}, {"quad", "normal"},
                                  {"corner", "normal"}, {"corner", "plane"}, {"corner", "facing"}};

// Every pixel that the first pair drew on.
std::vector<unsigned char> drawn(const Frame& frame) {
  std::vector<unsigned char> mask;
  for (const float depth : depth_of(frame).pixels) mask.push_back(depth < 1);
  return mask;
}

struct Plane {
  std::string_view name;
  int surfels_a_side;
};
constexpr Plane kPlanes[] = {{"table1", 256}, {"dense", 512}};  // the first is that of Table 1

traces::Scene scene_of(const Plane& plane) {
  const std::string text = fmt::format(
      "[surfels]\ngenerator = \"plane\"\ncolumns = {0}\nrows = {0}\n[frame]\nwidth = 512\nheight = 512\n"
      "[splatting]\nalgorithm = \"ewa-per-surfel\"\n",
      plane.surfels_a_side);
  return traces::parse_scene(text, std::string(plane.name));
}

void add_table(Findings& findings, const Plane& plane, const std::vector<VertexDataRow>& rows) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const VertexDataRow& row : rows) {
    cells.push_back({std::string(row.programs.visibility), std::string(row.programs.ewa), row.machine,
                     fmt::format("{} + {}", row.visibility_slots, row.ewa_slots),
                     fmt::format("{} + {}", row.visibility_bytes, row.ewa_bytes),
                     fmt::format("{}", row.surfel_bytes()), text_of_rate(row.video), text_of_rate(row.agp),
                     fmt::format("{:.1f}", row.psnr)});
  }
  findings.table(
      fmt::format("Plane of {0} x {0} surfels at 512 x 512. Slots and bytes a vertex of the two passes; "
                  "bytes read for a surfel in a frame; frames a second, and the busiest unit, with the "
                  "vertices in video and in AGP memory; PSNR against the first pair's picture.",
                  plane.surfels_a_side),
      {{"pass 1"},
       {"pass 2"},
       {"machine"},
       {"slots", number},
       {"bytes", number},
       {"a surfel", number},
       {"video, fps", number},
       {"AGP, fps", number},
       {"PSNR, dB", number}},
      cells);
}

Plot::Series points(const std::string& name) {
  return {.name = name, .joined = false};
}

Plot slots_plot(const std::vector<VertexDataRow>& rows) {
  Plot plot{.title = "Instructions against bytes",
            .x_label = "bytes read for a surfel in a frame",
            .y_label = "instruction slots of both passes"};
  for (const VertexDataRow& row : rows) {
    if (row.machine != kBothMachines[0]) continue;
    plot.series.push_back(points(fmt::format("{}, {}", row.programs.visibility, row.programs.ewa)));
    plot.series.back().x = {static_cast<double>(row.surfel_bytes())};
    plot.series.back().y = {static_cast<double>(row.slots())};
  }
  return plot;
}

Plot rate_plot(const Plane& plane, const std::vector<VertexDataRow>& rows) {
  Plot plot{.title = fmt::format("Frame rate against instructions, {0} x {0} surfels", plane.surfels_a_side),
            .x_label = "instruction slots of both passes",
            .y_label = "frames a second"};
  for (const std::string_view machine : kBothMachines) {
    Plot::Series video = points(fmt::format("{}, video memory", machine));
    Plot::Series agp = points(fmt::format("{}, AGP memory", machine));
    for (const VertexDataRow& row : rows) {
      if (row.machine != machine) continue;
      for (Plot::Series* series : {&video, &agp}) series->x.push_back(row.slots());
      video.y.push_back(row.video.fps);
      agp.y.push_back(row.agp.fps);
    }
    plot.series.push_back(std::move(video));
    plot.series.push_back(std::move(agp));
  }
  return plot;
}

}  // namespace

nlohmann::ordered_json json_of(const std::vector<VertexDataRow>& rows) {
  auto list = nlohmann::ordered_json::array();
  const auto rate = [](const Rate& r) {
    return nlohmann::ordered_json{{"frames_per_second", r.fps}, {"bottleneck", r.bottleneck}};
  };
  for (const VertexDataRow& row : rows) {
    list.push_back({{"visibility_program", row.programs.visibility},
                    {"ewa_program", row.programs.ewa},
                    {"machine", row.machine},
                    {"vs1", row.visibility_slots},
                    {"vs2", row.ewa_slots},
                    {"vertex_bytes_1", row.visibility_bytes},
                    {"vertex_bytes_2", row.ewa_bytes},
                    {"surfel_bytes", row.surfel_bytes()},
                    {"video", rate(row.video)},
                    {"agp", rate(row.agp)},
                    {"psnr_decibels", row.psnr}});  // null: equal pictures
  }
  return list;
}

std::vector<VertexDataRow> vertex_data_rows(const traces::Scene& scene, const Progress& progress) {
  std::vector<VertexDataRow> rows;
  constexpr double kRuns = 2 * std::size(kBothMachines) * std::size(kPairs);
  double runs = 0;
  for (const std::string_view name : kBothMachines) {
    const Machine machine = machine::load(name);
    // Captured without prefilter: the same whatever the programs.
    const traces::CapturedWeights weights = traces::capture_weights(scene, machine.numbers);
    std::optional<Frame> first;
    for (const ProgramPair& pair : kPairs) {
      traces::Scene changed = scene;
      traces::Splatting& splatting = changed.splatting;
      splatting.visibility_program = pair.visibility;
      splatting.ewa_program = pair.ewa;
      const kernels::SplatProgram& visibility = kernels::visibility_program(pair.visibility);
      const kernels::SplatProgram& ewa = kernels::ewa_program(pair.ewa);
      const auto run = [&](traces::VertexMemory memory) {
        splatting.vertex_memory = memory;
        FrameRun done = run_frame(traces::record(changed, weights).trace, machine, Fidelity::throughput,
                                  part(progress, runs / kRuns, (runs + 1) / kRuns));
        ++runs;
        return done;
      };
      const FrameRun video = run(traces::VertexMemory::video), agp = run(traces::VertexMemory::agp);
      if (!first) first = video.rendered.frame;
      rows.push_back({.programs = pair,
                      .machine = std::string(name),
                      .visibility_slots = slots_of(kernels::shader_text(visibility.file)),
                      .ewa_slots = slots_of(kernels::shader_text(ewa.file)),
                      .visibility_bytes = kernels::vertex_bytes(visibility.fields),
                      .ewa_bytes = kernels::vertex_bytes(ewa.fields),
                      .video = rate_of(*video.timing),
                      .agp = rate_of(*agp.timing),
                      .psnr = psnr(picture_of(video.rendered.frame), picture_of(*first), drawn(*first))});
    }
  }
  return rows;
}

void study_vertex_data(Findings& findings, const Progress& progress) {
  findings.report().heading("Instructions against bytes: section 8");
  auto results = nlohmann::ordered_json::object();
  double done = 0;
  for (const Plane& plane : kPlanes) {
    const double next = done + (plane.surfels_a_side == 256 ? 0.3 : 0.7);
    const auto rows = vertex_data_rows(scene_of(plane), part(progress, done, next));
    done = next;
    findings.say(fmt::format("{0} x {0} surfels\n", plane.surfels_a_side));
    add_table(findings, plane, rows);
    if (results.empty()) findings.plot("vertex-data-slots", slots_plot(rows));
    findings.plot(fmt::format("vertex-data-{}", plane.name), rate_plot(plane, rows));
    results[std::string(plane.name)] = json_of(rows);
  }
  findings.result("vertex_data", std::move(results));
}

}  // namespace splatscope::studies
