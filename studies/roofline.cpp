#include "studies/roofline.h"

#include <fmt/format.h>

#include <algorithm>

namespace splatscope::studies {
namespace {

// Summed over the units whose name begins so: "memory" for all channels.
double total(const sim::Result& timing, std::string_view units, std::string_view statistic) {
  double sum = 0;
  for (const sim::UnitStatistic& s : timing.statistics) {
    if (s.unit_name.starts_with(units) && s.name == statistic) sum += static_cast<double>(s.value);
  }
  return sum;
}

std::string si(double value) {
  return value >= 1e9 ? fmt::format("{:.2f} G", value / 1e9) : fmt::format("{:.0f} M", value / 1e6);
}

}  // namespace

std::vector<Ceiling> ceilings(const Machine& machine, const sim::Result& timing) {
  if (timing.statistics.empty()) return {};
  const double core = 1e6 * machine.clock.core_megahertz, bus = 1e6 * machine.clock.bus_megahertz;
  const double memory_clock = machine.memory.channel_bytes_per_clock, bus_clock = machine.agp.bytes_per_clock;
  std::vector<Ceiling> list = {{"instructions", "slots", "issue slots of all vertex units",
                                total(timing, "vertex", "issue_slots"), core * machine.vertex.units, 0, 0},
                               {"fill", "quads", "2x2 quads out of the rasteriser",
                                total(timing, "raster", "quads"), core * machine.pixel.quads_per_clock, 0, 0},
                               {"memory", "bytes", "on the data buses of video memory",
                                total(timing, "memory", "data_clocks") * memory_clock,
                                core * memory_clock * machine.memory.channels, 0, 0},
                               {"bus", "bytes", "that AGP carries to the GPU in the clocks with data",
                                total(timing, "agp", "data_clocks") * bus_clock, bus * bus_clock, 0, 0}};
  for (Ceiling& c : list) {
    c.share = c.demand / c.peak / timing.seconds;
    c.fps = static_cast<double>(timing.frame_cycles.size()) * c.peak / c.demand;
  }
  return list;
}

std::optional<Plot> roofline_plot(const std::vector<Ceiling>& ceilings, double seconds) {
  if (ceilings.empty() || ceilings.front().demand == 0) return {};
  const Ceiling& instructions = ceilings.front();
  double least = 1e300, most = 0;
  for (const Ceiling& c : std::span(ceilings).subspan(1)) {
    if (c.demand == 0) continue;
    for (const double x : {instructions.demand / c.demand, instructions.peak / c.peak}) {
      least = std::min(least, x / 4);
      most = std::max(most, x * 4);
    }
  }
  if (most == 0) return {};
  Plot plot{.title = "Roofline of the run: vertex instructions against what each of them costs elsewhere",
            .x_label = "vertex instructions a byte (memory, bus) or a quad (fill)",
            .y_label = "vertex instructions a second",
            .log_x = true,
            .log_y = true};
  plot.series.push_back({fmt::format("instructions, {}slots/s", si(instructions.peak)),
                         {least, most},
                         {instructions.peak, instructions.peak}});
  for (const Ceiling& c : std::span(ceilings).subspan(1)) {
    if (c.demand == 0) continue;
    const double ridge = instructions.peak / c.peak;  // where the two roofs meet
    plot.series.push_back({fmt::format("{}, {}{}/s", c.name, si(c.peak), c.unit),
                           {least, ridge},
                           {least * c.peak, instructions.peak}});
    plot.series.push_back({fmt::format("the run under {}: {:.0f} % of it", c.name, 100 * c.share),
                           {instructions.demand / c.demand},
                           {instructions.demand / seconds},
                           false,
                           true});
  }
  return plot;
}

nlohmann::ordered_json json_of(const std::vector<Ceiling>& ceilings) {
  auto list = nlohmann::ordered_json::array();
  for (const Ceiling& c : ceilings) {
    list.push_back({{"name", c.name},
                    {"unit", c.unit},
                    {"what", c.what},
                    {"demand", c.demand},
                    {"peak_per_second", c.peak},
                    {"share", c.share},
                    {"frames_per_second", c.fps}});  // null where nothing is asked
  }
  return list;
}

}  // namespace splatscope::studies
