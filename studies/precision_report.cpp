#include <fmt/format.h>

#include <algorithm>

#include "studies/precision.h"
#include "studies/run.h"

namespace splatscope::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kOverlaps[] = {1, 2, 4, 8, 16, 32, 64, 128, 300};
constexpr double kOffsets[] = {0.03, 0.06, 0.125, 0.25, 0.5, 1, 2, 4, 8};

Json json_of(const Errors& e) {
  return {{"psnr_decibels", e.psnr}, {"mean", e.mean},           {"percentile_99", e.percentile99},
          {"bias", e.bias},          {"saturated", e.saturated}, {"black", e.black}};
}

Json json_of(std::span<const SwitchRow> rows, std::span<const PrecisionScene> scenes) {
  Json list = Json::array();
  for (const SwitchRow& row : rows) {
    Json one = {{"step", row.setting.step},
                {"level", row.setting.level},
                {"of_the_machine", row.setting.of_the_machine}};
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      one["alone"][scenes[i].name] = json_of(row.alone[i]);
      one["in_machine"][scenes[i].name] = json_of(row.in_machine[i]);
    }
    list.push_back(std::move(one));
  }
  return list;
}

void add_table(Report& report, std::span<const SwitchRow> rows, std::span<const PrecisionScene> scenes) {
  using enum Report::Align;
  std::vector<Report::Column> columns{{"step"}, {"level"}};
  for (const char* where : {"alone", "machine"}) {
    for (const PrecisionScene& scene : scenes)
      columns.push_back({fmt::format("{}, {}", scene.name, where), number});
  }
  std::vector<std::vector<std::string>> cells;
  for (const SwitchRow& row : rows) {
    std::vector<std::string> line{row.setting.step, row.setting.level};
    for (const auto* errors : {&row.alone, &row.in_machine}) {
      for (const Errors& e : *errors) {
        line.push_back(fmt::format("{:.1f} ({:.1f}, {:.0f}; {:.1f} %, {:.1f} %)", e.psnr, e.mean,
                                   e.percentile99, 100 * e.saturated, 100 * e.black));
      }
    }
    cells.push_back(std::move(line));
  }
  report.table(
      "PSNR in dB (mean and 99th percentile of a pixel's largest error, in 1/255; fraction of pixels "
      "saturated, and black where they should not be) against the double-precision reference: each step "
      "alone in an otherwise exact pipeline, and on the GeForce4 with that one step changed.",
      columns, cells);
}

// PSNR by the levels of some steps, which are numbers, of the rows' errors alone or in the machine.
Plot step_plot(std::span<const SwitchRow> rows, std::span<const PrecisionScene> scenes,
               const std::string& title, const std::string& label, std::span<const std::string_view> steps,
               bool log_x, std::vector<Errors> SwitchRow::*errors = &SwitchRow::alone) {
  Plot plot{.title = title, .x_label = label, .y_label = "PSNR, dB", .log_x = log_x};
  for (const std::string_view step : steps) {
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      Plot::Series series{
          .name = steps.size() > 1 ? fmt::format("{}, {}", step, scenes[i].name) : scenes[i].name,
          .x = {},
          .y = {}};
      for (const SwitchRow& row : rows) {
        if (row.setting.step != step) continue;
        series.x.push_back(std::stod(row.setting.level));
        series.y.push_back((row.*errors)[i].psnr);
      }
      plot.series.push_back(std::move(series));
    }
  }
  return plot;
}

void add_overlaps(Findings& findings, const std::vector<OverlapRow>& rows) {
  Plot plot{.title = "A frame buffer's bias by the number of splats on a pixel",
            .x_label = "splats that touch a pixel",
            .y_label = "mean error, 1/255",
            .log_x = true};
  Json list = Json::array();
  std::string text = fmt::format("{:<18}", "splats on a pixel");
  for (const double count : kOverlaps) text += fmt::format("{:>14.0f}", count);
  text += "\n";
  for (std::size_t i = 0; i < rows.size() / std::size(kOverlaps); ++i) {
    const std::size_t buffers = rows.size() / std::size(kOverlaps);
    Plot::Series series{.name = rows[i].frame};
    text += fmt::format("{:<18}", rows[i].frame);
    for (std::size_t k = i; k < rows.size(); k += buffers) {
      series.x.push_back(rows[k].overlaps);
      series.y.push_back(rows[k].bias);
      text += fmt::format("{:>+7.1f} {:>4.0f}% ", rows[k].bias, 100 * rows[k].black);
      list.push_back({{"frame", rows[k].frame},
                      {"overlaps", rows[k].overlaps},
                      {"bias", rows[k].bias},
                      {"saturated", rows[k].saturated},
                      {"black", rows[k].black}});
    }
    text += "\n";
    plot.series.push_back(std::move(series));
  }
  findings.text(text);
  findings.say("\n");
  findings.plot("precision-overlaps", plot);
  findings.result("precision_overlaps", std::move(list));
}

void add_depths(Findings& findings, const std::vector<DepthRow>& rows) {
  Plot plot{.title = "Depth formats against z_t: what is lost, and what shines through",
            .x_label = "z_t, spacings of the surfels",
            .y_label = "fraction",
            .log_x = true};
  Json list = Json::array();
  std::string text = fmt::format("{:<8} {:>6} {:>8} {:>8} {:>8}\n", "depth", "z_t", "lost", "holes", "leaks");
  for (const DepthRow& row : rows) {
    text += fmt::format("{:<8} {:>6} {:>6.1f} % {:>6.1f} % {:>6.1f} %\n", row.format, row.offset,
                        100 * row.lost, 100 * row.holes, 100 * row.leaks);
    list.push_back({{"format", row.format},
                    {"z_t_spacings", row.offset},
                    {"lost", row.lost},
                    {"holes", row.holes},
                    {"leaks", row.leaks}});
    if (plot.series.empty() ||
        plot.series[plot.series.size() - 2].name != fmt::format("{}, lost", row.format)) {
      for (const char* what : {"lost", "leaks"})
        plot.series.push_back({.name = fmt::format("{}, {}", row.format, what)});
    }
    Plot::Series& lost = plot.series[plot.series.size() - 2];
    Plot::Series& leaks = plot.series.back();
    for (Plot::Series* series : {&lost, &leaks}) series->x.push_back(row.offset);
    lost.y.push_back(row.lost);
    leaks.y.push_back(row.leaks);
  }
  findings.text(text);
  findings.plot("precision-depth", plot);
  findings.result("precision_depth", std::move(list));
}

// Single steps whose errors an eye sees, on the last of the scenes.
void add_pictures(Findings& findings, std::span<const Switch> switches, const PrecisionScene& scene) {
  constexpr std::pair<std::string_view, std::string_view> kShown[] = {
      {"nothing", ""},     {"texture size", "16"},     {"circle, c", "0.5"},   {"frame", "8 bits, truncated"},
      {"frame", "8 bits"}, {"gamma, per surfel", "1"}, {"RCP, RSQ bits", "8"}, {"sub-pixel bits", "0"}};
  std::vector<Findings::Picture> pictures;
  for (const auto& [step, level] : kShown) {
    const auto shown =
        std::ranges::find_if(switches, [&](const Switch& s) { return s.step == step && s.level == level; });
    if (shown == switches.end()) continue;
    Pipeline pipeline = ideal_pipeline();
    shown->turn(pipeline);
    pictures.push_back({fmt::format("precision-{}", pictures.size() + 1), shown->step + " " + shown->level,
                        picture_of(draw(scene.scene, pipeline))});
  }
  findings.pictures(pictures);
}

}  // namespace

std::string header_of_switches(std::span<const PrecisionScene> scenes) {
  std::string text = fmt::format("{:<18} {:<20}", "", "");
  for (const PrecisionScene& scene : scenes) text += fmt::format("  {:^23}", scene.name);
  text += fmt::format("\n{:<18} {:<20}", "step", "level");
  for (std::size_t i = 0; i < scenes.size(); ++i)
    text += fmt::format("  {:<11} {:<11}", "alone", "in machine");
  return text;
}

std::string line_of(const SwitchRow& row) {
  std::string text = fmt::format("{:<18} {:<20}", row.setting.step,
                                 row.setting.level + (row.setting.of_the_machine ? " *" : ""));
  for (std::size_t i = 0; i < row.alone.size(); ++i) {
    text += " ";
    for (const Errors* e : {&row.alone[i], &row.in_machine[i]})
      text += fmt::format(" {:>5.1f} {:>5.1f}", e->psnr, e->percentile99);
  }
  return text;
}

void study_precision(Findings& findings, const Progress& progress) {
  constexpr int kFrame = 256, kSide = 128;
  findings.report().heading("What each lossy step costs");
  std::vector<PrecisionScene> scenes;
  for (const double tilt : {0.0, 45.0, 75.0}) scenes.push_back(precision_plane(tilt, kSide, kFrame));
  scenes.push_back(precision_model(60000, kFrame));
  if (progress) progress(0.05);
  const auto switches = precision_switches();
  const auto rows = switch_rows(switches, scenes, part(progress, 0.05, 0.85));
  findings.say(header_of_switches(scenes) + "\n");
  for (const SwitchRow& row : rows) findings.say(line_of(row) + "\n");
  findings.say("\n");
  add_table(findings.report(), rows, scenes);
  constexpr std::string_view kSize[] = {"texture size", "size, bilinear"}, kTexels[] = {"texel bits"},
                             kBits[] = {"RCP, RSQ bits"}, kSubpixels[] = {"sub-pixel bits"},
                             kGamma[] = {"gamma, per pixel", "gamma, per surfel"};
  findings.plot("precision-texture",
                step_plot(rows, scenes, "Size of the alpha texture", "texels along a side", kSize, true));
  findings.plot("precision-texels", step_plot(rows, scenes, "Bits of a texel", "bits", kTexels, false));
  findings.plot("precision-reciprocals",
                step_plot(rows, scenes, "Significant bits of RCP and RSQ", "bits", kBits, false));
  findings.plot("precision-subpixels",
                step_plot(rows, scenes, "Sub-pixel bits of the window", "bits", kSubpixels, false));
  findings.plot("precision-gamma", step_plot(rows, scenes, "Gamma, on the machine", "gamma", kGamma, false,
                                             &SwitchRow::in_machine));
  findings.result("precision", json_of(rows, scenes));
  add_pictures(findings, switches, scenes.back());
  add_overlaps(findings, overlap_rows(kOverlaps, 96));
  if (progress) progress(0.95);
  add_depths(findings, depth_rows(kOffsets, 128));
}

}  // namespace splatscope::studies
