#include "studies/report/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "studies/reference_comparison.h"
#include "studies/report/block_diagram.h"
#include "studies/report/configuration.h"
#include "studies/roofline.h"

namespace splatscope::studies {
namespace {

using Json = nlohmann::ordered_json;
using enum Report::Align;

// A count as people read it: 1 234 567.
std::string grouped(std::uint64_t value) {
  std::string digits = fmt::format("{}", value);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), 1, ' ');
  return digits;
}

void add_picture(Report& report, const FrameRun& run) {
  const Image picture = picture_of(run.rendered.frame);
  if (!run.reference) {
    report.pictures({{"frame", "as the frame buffer holds it: no gamma is applied", picture}});
    return;
  }
  const Comparison& c = run.reference->comparison;
  std::string agreement = describe_psnr(c);
  if (c.surface_pixels > 0) agreement += fmt::format(", at worst {:.0f}/255", c.worst);
  if (c.pixels_off_edges > 0) agreement += fmt::format(", {:.1f} dB off edges", c.psnr_off_edges);
  if (c.inside_pixels > 0) agreement += fmt::format(", {} holes", c.holes);
  report.comparisons({{{"frame", agreement, picture},
                       picture_of(run.reference->picture),
                       difference_picture(run.rendered.frame, run.reference->picture)}});
}

void add_times(Report& report, const sim::Result& timing) {
  std::vector<std::vector<std::string>> rows;
  for (const sim::Cycle cycles : timing.frame_cycles) {
    const std::size_t frame = rows.size();
    const double half_width = timing.frame_plus_minus.empty() ? 0 : timing.frame_plus_minus[frame];
    const std::string plus_minus =
        half_width > 0 ? fmt::format(" ± {}", grouped(static_cast<std::uint64_t>(std::llround(half_width))))
                       : "";
    rows.push_back({fmt::format("{}", frame), grouped(cycles) + plus_minus,
                    fmt::format("{:.3f}", 1000 * timing.seconds_of(cycles)),
                    fmt::format("{:.2f}", timing.frames_per_second(cycles))});
  }
  const sim::Result::Bottleneck bottleneck = timing.bottleneck();
  const std::string busiest =
      bottleneck.vertex_units > 1
          ? fmt::format("Each of the {} vertex units was busy at least", bottleneck.vertex_units)
          : bottleneck.unit + " was the busiest unit,";
  report.table(fmt::format("Time. {} {:.0f} % of the cycles.", busiest, 100 * timing.share(bottleneck.busy)),
               {{"frame", number}, {"core cycles", number}, {"ms", number}, {"frames/s", number}}, rows);
}

void add_roofline(Report& report, const Machine& machine, const sim::Result& timing) {
  const std::vector<Ceiling> list = ceilings(machine, timing);
  if (list.empty()) return;
  report.heading("Roofline");
  std::vector<std::vector<std::string>> rows;
  for (const Ceiling& c : list) {
    rows.push_back({c.name, c.what, fmt::format("{:.4g} {}", c.demand, c.unit),
                    fmt::format("{:.4g} {}/s", c.peak, c.unit), fmt::format("{:.1f} %", 100 * c.share),
                    c.demand == 0 ? "-" : fmt::format("{:.1f}", c.fps)});
  }
  report.table(
      "What the run asked for, what the machine can give, and the frame rate if nothing else took time.",
      {{"ceiling"},
       {"what"},
       {"asked for", number},
       {"peak", number},
       {"used", number},
       {"frames/s", number}},
      rows);
  if (const auto plot = roofline_plot(list, timing.seconds)) add_plot(report, *plot);
}

void add_counts(Report& report, const Json& results) {
  report.heading("Counts");
  std::vector<std::vector<std::string>> programs;
  for (const Json& program : results.at("programs"))
    programs.push_back({program.at("name"), grouped(program.at("slots").get<std::uint64_t>())});
  report.table("The programs, and the instruction slots that each takes.", {{"program"}, {"slots", number}},
               programs);
  const std::vector<Report::Column> columns = {
      {"of"}, {"what", prose}, {"name"}, {"value", number}, {"unit"}};
  std::vector<std::vector<std::string>> rows;
  for (const char* list : {"totals", "statistics"}) {
    if (!results.contains(list)) continue;
    for (const Json& entry : results.at(list)) {
      rows.push_back({entry.value("of", "the trace"), entry.at("what"), entry.at("name"),
                      grouped(entry.at("value").get<std::uint64_t>()), entry.at("unit")});
    }
  }
  report.folded_table(fmt::format("{} counts of the work and of the units", rows.size()), columns, rows);
}

void add_heat_maps(Report& report, const std::vector<HeatMap>& maps) {
  if (maps.empty()) return;
  report.heading("Heat maps");
  std::vector<Image> images;
  std::vector<Report::Picture> pictures;
  images.reserve(maps.size());  // pictures refer to them
  for (const HeatMap& map : maps) {
    images.push_back(colored(map));
    const float most = *std::ranges::max_element(map.image.pixels);
    pictures.push_back({map.name,
                        fmt::format("{}: {} {}, at most {:.0f}; black is 0, colours go by its logarithm",
                                    map.what, grouped(map.sum), map.unit, most),
                        images.back(), Report::Counts{&map.image, map.unit}});
  }
  report.pictures(pictures);
}

}  // namespace

Report run_report(const Input& input, const Machine& machine, const FrameRun& run, const Json& results) {
  Report report(
      fmt::format("splatscope: {}", input.name),
      fmt::format("One run on {}, fidelity {}.", machine.title, results.at("fidelity").get<std::string>()));
  add_picture(report, run);
  if (run.timing) {
    add_times(report, *run.timing);
    add_roofline(report, machine, *run.timing);
    report.heading("The machine");
    add_machine(report, "Where the cycles of each unit went, and what went between the units.", *run.timing);
  }
  add_heat_maps(report, run.heat_maps);
  add_counts(report, results);
  report.heading("Configuration");
  add_configuration(report, machine);
  return report;
}

}  // namespace splatscope::studies
