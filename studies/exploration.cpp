#include "studies/exploration.h"

#include <fmt/format.h>

#include "studies/report/block_diagram.h"
#include "studies/wished_hardware.h"

namespace splatscope::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRandomSurfels = 100000;
constexpr std::string_view kPrograms[] = {"paper", "normal", "plane", "facing"};
constexpr std::string_view kScene = "checkerboard-ewa-per-surfel";

Json json_of(const Rate& rate) {
  return {{"frames_per_second", rate.fps},
          {"bottleneck", rate.bottleneck},
          {"bottleneck_busy_share", rate.share}};
}

Json json_of(const kernels::SplatErrors& errors) {
  return {{"standard_deviation", errors.deviation},
          {"weight", errors.weight},
          {"corner_pixels", errors.corner},
          {"window_corner_pixels", errors.window_corner}};
}

Json json_of(std::span<const ProgramRow> rows) {
  Json list = Json::array();
  for (const ProgramRow& row : rows) {
    Json rates = Json::object();
    for (std::size_t i = 0; i < row.rates.size(); ++i)
      rates[std::string(kBothMachines[i])] = json_of(row.rates[i]);
    list.push_back({{"program", row.name},
                    {"slots", row.slots},
                    {"every_instruction_live", row.live},
                    {"rates", rates},
                    {"speedup_first_machine", row.rates[0].fps / rows[0].rates[0].fps},
                    {"errors_ieee", json_of(row.ieee)},
                    {"errors_nv20", json_of(row.nv20)},
                    {"psnr_paper_decibels", row.psnr_paper},  // null: equal pictures
                    {"psnr_paper_one_weight_decibels", row.psnr_paper_one_weight},
                    {"psnr_reference_decibels", row.psnr_reference}});
  }
  return list;
}

Json json_of(const HardwareRow& row) {
  Json cells = Json::array();
  for (const HardwareRow::Cell& cell : row.cells) {
    Json one = json_of(cell.rate);
    one["megabytes"] = cell.megabytes;
    one["psnr_decibels"] = cell.psnr;
    cells.push_back(std::move(one));
  }
  return {{"hardware", row.hardware.name}, {"cost", row.hardware.cost},
          {"machine", row.machine},        {"no-ewa", cells[0]},
          {"ewa-per-pixel", cells[1]},     {"ewa-per-surfel", cells[2]}};
}

void add_table(Findings& findings, std::span<const ProgramRow> rows) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const ProgramRow& row : rows) {
    cells.push_back({std::string(row.name), fmt::format("{}", row.slots), row.live ? "all" : "no",
                     text_of_rate(row.rates[0]), text_of_rate(row.rates[1]),
                     fmt::format("{:.2f}", row.rates[0].fps / rows[0].rates[0].fps),
                     fmt::format("{:.1e}, {:.1e}", row.ieee.deviation, row.nv20.deviation),
                     fmt::format("{:.1f}, {:.1f}", row.psnr_paper, row.psnr_paper_one_weight),
                     fmt::format("{:.1f}", row.psnr_reference)});
  }
  findings.table(
      "Programs of the EWA filter on the plane of Table 1, at fidelity cycle: instruction slots, and whether "
      "every instruction is live; frames a second, and the busiest unit; speedup on the GeForce4; the "
      "standard deviation's largest relative error over 100,000 random surfels, IEEE and NV20 arithmetic; "
      "PSNR to the paper's program in float, with a weight a corner and one a surfel; to the reference on "
      "the GeForce4.",
      {{"program"},
       {"slots", number},
       {"live"},
       {"GeForce4, fps", number},
       {"Radeon, fps", number},
       {"speedup", number},
       {"standard deviation", number},
       {"PSNR to the paper's, dB", number},
       {"PSNR, dB", number}},
      cells);
}

void add_table(Report& report, const std::vector<HardwareRow>& rows) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const HardwareRow& row : rows) {
    const auto rate = [&](std::size_t i) {
      return fmt::format("{:.1f} ({})", row.cells[i].rate.fps, row.cells[i].rate.bottleneck);
    };
    cells.push_back({row.hardware.name, row.hardware.cost, row.machine, rate(0), rate(1), rate(2),
                     fmt::format("{:.1f}", row.cells[2].megabytes), fmt::format("{:.1f}", row.cells[1].psnr),
                     fmt::format("{:.1f}", row.cells[2].psnr)});
  }
  report.table(
      "Other hardware on the scenes of Table 1, at fidelity throughput: frames a second and the "
      "busiest unit; megabytes to and from video memory for a frame, normalised per surfel; PSNR per pixel "
      "and per surfel.",
      {{"hardware"},
       {"cost"},
       {"machine"},
       {"no-ewa", number},
       {"ewa-per-pixel", number},
       {"ewa-per-surfel", number},
       {"MB a frame", number},
       {"PSNR per pixel, dB", number},
       {"PSNR per surfel, dB", number}},
      cells);
}

// Frames a second of ewa-per-surfel by the number of vertex units; nothing else is changed.
Plot units_plot(const std::vector<HardwareRow>& rows) {
  Plot plot{.title = "Vertex units, EWA normalised per surfel",
            .x_label = "vertex units",
            .y_label = "frames a second"};
  for (const std::string_view machine : kBothMachines) {
    for (const bool short_programs : {false, true}) {
      std::vector<std::pair<double, double>> points;
      for (const HardwareRow& row : rows) {
        const Hardware& h = row.hardware;
        if (row.machine == machine && h.short_programs == short_programs && h.frame == FrameFormat::unorm8 &&
            !h.divider && h.geometry == Geometry::four_vertices) {
          points.emplace_back(h.vertex_units, row.cells[2].rate.fps);
        }
      }
      std::ranges::sort(points);
      Plot::Series series{
          .name = fmt::format("{}, {} programs", machine, short_programs ? "short" : "the paper's"),
          .x = {},
          .y = {}};
      for (const auto& [units, fps] : points) {
        series.x.push_back(units);
        series.y.push_back(fps);
      }
      plot.series.push_back(std::move(series));
    }
  }
  return plot;
}

void add_pictures(Findings& findings, const traces::Scene& scene) {
  const auto picture = [&](std::string_view hardware, const std::string& name, const std::string& what) {
    const auto found = std::ranges::find(wished_hardware(), hardware, &Hardware::name);
    const HardwarePicture drawn =
        hardware_picture(scene, kBothMachines[0], *found, traces::Algorithm::ewa_per_pixel);
    return Findings::Picture{name, fmt::format("{}: {:.1f} dB", what, drawn.psnr), drawn.image};
  };
  findings.pictures({picture("as it was", "exploration-as-it-was", "EWA, normalised per pixel"),
                     picture("half frame", "exploration-half", "the same into a half-float frame"),
                     picture("point sprites", "exploration-sprites", "circles, as point sprites draw them")});
}

}  // namespace

void study_exploration(Findings& findings, const Progress& progress) {
  findings.report().heading("What the authors could have had");
  const traces::Scene scene = traces::load_scene(kScene);
  const auto programs =
      program_rows(scene, kPrograms, Fidelity::cycle, kRandomSurfels, part(progress, 0, 0.5));
  add_table(findings, programs);
  findings.say("\n");
  for (const ProgramRow* row : {&programs.front(), &programs.back()}) {
    add_machine(
        findings.report(),
        fmt::format("The {} with the program \"{}\", {} slots", kBothMachines[0], row->name, row->slots),
        row->timing);
  }
  std::vector<HardwareRow> rows;
  double done = 0.5;
  for (const std::string_view machine : kBothMachines) {
    const auto more = hardware_rows(scene, machine, wished_hardware(), part(progress, done, done + 0.25));
    rows.insert(rows.end(), more.begin(), more.end());
    done += 0.25;
  }
  findings.say(header_of_hardware() + "\n");
  Json list = Json::array();
  for (const HardwareRow& row : rows) {
    findings.say(line_of(row) + "\n");
    list.push_back(json_of(row));
  }
  add_table(findings.report(), rows);
  add_pictures(findings, scene);
  findings.plot("exploration-units", units_plot(rows));
  findings.result("exploration", {{"programs", json_of(programs)}, {"hardware", std::move(list)}});
}

}  // namespace splatscope::studies
