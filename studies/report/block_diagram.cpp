#include "studies/report/block_diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <vector>

namespace splatscope::studies {
namespace {

// All in the drawing's units, of which a pixel is about one on a wide screen.
constexpr double kWidth = 480, kPipelineLeft = 56, kPipelineRight = 324, kMemoryLeft = 376,
                 kMemoryRight = 472;
constexpr double kBoxHeight = 44, kRowStep = 68, kTop = 4, kGap = 8;
constexpr std::size_t kMostInRow = 4;

bool is_numbered(std::string_view name, std::string_view kind) {
  return name.size() > kind.size() && name.starts_with(kind) &&
         std::isdigit(static_cast<unsigned char>(name[kind.size()])) != 0;
}

// Units of the same stage stand side by side.
constexpr std::string_view kStages[] = {"host",   "command", "vertex_fetch", "vertex0", "primitive", "setup",
                                        "raster", "depth",   "texture",      "pixel",   "blend"};
std::size_t stage_of(std::string_view name) {
  if (name == "agp") name = "command";
  if (is_numbered(name, "vertex")) name = "vertex0";
  return static_cast<std::size_t>(std::ranges::find(kStages, name) - std::begin(kStages));
}

struct Box {
  const sim::UnitBooks* books;
  std::size_t row;  // of the memory: none
  double left, top, width;
  double middle() const { return left + width / 2; }
  double bottom() const { return top + kBoxHeight; }
  double right() const { return left + width; }
};

class Diagram {
 public:
  explicit Diagram(const sim::Result& timing) : timing_(timing) {
    place_pipeline();
    place_memory();
  }

  std::string svg() const {
    std::string out = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"the machine\">\n",
                                  kWidth, kTop + kRowStep * static_cast<double>(rows_));
    if (memories_ != 0) {
      out += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"4\"/>\n",
                         kMemoryLeft - kGap, memory_top(), kMemoryRight - kMemoryLeft + 2 * kGap,
                         memory_bottom() - memory_top());
    }
    return out + ways() + boxes() + "</svg>";
  }

 private:
  void place_pipeline() {
    std::map<std::size_t, std::vector<const sim::UnitBooks*>> stages;
    for (const sim::UnitBooks& unit : timing_.units) {
      if (is_numbered(unit.name, "memory")) continue;
      std::size_t stage = stage_of(unit.name);
      if (stage == std::size(kStages)) stage += stages.size();  // a row of its own
      stages[stage].push_back(&unit);
    }
    for (auto& [stage, units] : stages) {
      // The bus first: the command processor is then on the side of the memory.
      std::ranges::stable_partition(units, [](const auto* unit) { return unit->name == "agp"; });
      for (std::size_t first = 0; first < units.size(); first += kMostInRow) {
        place_row({units.begin() + static_cast<std::ptrdiff_t>(first),
                   units.begin() + static_cast<std::ptrdiff_t>(std::min(first + kMostInRow, units.size()))});
      }
    }
  }

  void place_row(const std::vector<const sim::UnitBooks*>& units) {
    const double step = (kPipelineRight - kPipelineLeft + kGap) / static_cast<double>(units.size());
    for (std::size_t i = 0; i < units.size(); ++i) {
      boxes_[units[i]->name] = {units[i], rows_, kPipelineLeft + step * static_cast<double>(i),
                                kTop + kRowStep * static_cast<double>(rows_), step - kGap};
    }
    ++rows_;
  }

  void place_memory() {
    for (const sim::UnitBooks& unit : timing_.units) memories_ += is_numbered(unit.name, "memory");
    // Enough rows for them, in the middle of the frame beside the pipeline.
    rows_ = std::max(rows_, memories_ + 1);
    const double height = static_cast<double>(memories_) * (kBoxHeight + kGap) - kGap;
    double top = (memory_top() + memory_bottom() - height) / 2;
    for (const sim::UnitBooks& unit : timing_.units) {
      if (!is_numbered(unit.name, "memory")) continue;
      boxes_[unit.name] = {&unit, 0, kMemoryLeft, top, kMemoryRight - kMemoryLeft};
      top += kBoxHeight + kGap;
    }
  }

  double memory_top() const { return kTop + kRowStep - kGap / 2; }  // below the host
  double memory_bottom() const {
    return kTop + kRowStep * static_cast<double>(rows_) - (kRowStep - kBoxHeight) / 2;
  }

  bool goes_past(const sim::ChannelUse& channel) const {
    if (is_numbered(channel.to, "memory")) return false;
    const std::size_t from = boxes_.at(channel.from).row, to = boxes_.at(channel.to).row;
    return from + 1 != to && to + 1 != from;
  }

  // Units in rows beside each other are joined straight, others by a way past the pipeline on its left; each
  // client has one line to the memory.
  std::string ways() const {
    std::string out;
    std::map<std::string, std::uint64_t> of_clients;
    const auto ways_past = static_cast<double>(
        std::ranges::count_if(timing_.channels, [this](const auto& channel) { return goes_past(channel); }));
    const double step = std::min(9.0, (kPipelineLeft - 14) / std::max(1.0, ways_past));  // as there is room
    double past = kPipelineLeft - 10;
    for (const sim::ChannelUse& channel : timing_.channels) {
      if (is_numbered(channel.to, "memory")) {
        of_clients[channel.from] += channel.items;
        continue;
      }
      const Box &from = boxes_.at(channel.from), &to = boxes_.at(channel.to);
      const std::string what = fmt::format("{} to {}: {} items", channel.from, channel.to, channel.items);
      const bool down = to.row > from.row;
      if (!goes_past(channel)) {
        const double x = (from.width < to.width ? from : to).middle() + (down ? -5 : 5);
        const double start = down ? from.bottom() : from.top, end = down ? to.top : to.bottom();
        out += way(fmt::format("M{} {}V{}", x, start, end),
                   fmt::format("M{} {}l-4 {}h8z", x, end, down ? -7 : 7), what);
      } else {
        const double start = from.top + kBoxHeight * 0.6, end = to.top + kBoxHeight * 0.4;
        out += way(fmt::format("M{} {}H{}V{}H{}", from.left, start, past, end, to.left),
                   head_right(to.left, end), what);
        past -= step;
      }
    }
    for (const auto& [client, requests] : of_clients) {
      const Box& from = boxes_.at(client);
      const double y = from.top + kBoxHeight / 2, end = kMemoryLeft - kGap;
      out += way(fmt::format("M{} {}H{}", from.right(), y, end), head_right(end, y),
                 fmt::format("{} to memory: {} requests", client, requests));
    }
    return out;
  }

  static std::string head_right(double x, double y) { return fmt::format("M{} {}l-7 -4v8z", x, y); }

  static std::string way(const std::string& path, const std::string& head, const std::string& what) {
    return fmt::format(
        "<g><title>{}</title><path class=\"way\" d=\"{}\"/><path class=\"head\" d=\"{}\"/></g>\n",
        escaped(what), path, head);
  }

  std::string boxes() const {
    std::string out;
    for (const auto& [name, box] : boxes_) out += box_of(box);
    return out;
  }

  double percent(sim::Cycle cycles) const { return 100 * timing_.share(cycles); }

  std::string box_of(const Box& box) const {
    const sim::UnitBooks& b = *box.books;
    std::string title =
        fmt::format("{}: busy {:.1f} %, starved {:.1f} %, blocked {:.1f} %, idle {:.1f} %", b.name,
                    percent(b.busy), percent(b.starved), percent(b.blocked), percent(b.idle));
    for (const auto& [by, cycles] : b.blocked_by)
      title += fmt::format("; blocked by {} {:.1f} %", by, percent(cycles));
    std::string out = fmt::format(
        "<g><title>{}</title><rect class=\"box\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"3\"/>"
        "<text x=\"{}\" y=\"{}\">{}</text><text class=\"share\" x=\"{}\" y=\"{}\">{:.0f} %</text>",
        escaped(title), box.left, box.top, box.width, kBoxHeight, box.left + 5, box.top + 15, escaped(b.name),
        box.right() - 5, box.top + (box.width < 110 ? 29 : 15), percent(b.busy));
    double x = box.left + 5;
    const double full = box.width - 10;
    for (const auto& [name, cycles] :
         {std::pair{"busy", b.busy}, {"starved", b.starved}, {"blocked", b.blocked}, {"idle", b.idle}}) {
      const double width = full * timing_.share(cycles);
      out += fmt::format("<rect class=\"{}\" x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"6\"/>", name, x,
                         box.bottom() - 11, width);
      x += width;
    }
    return out + "</g>\n";
  }

  const sim::Result& timing_;
  std::map<std::string, Box> boxes_;  // by unit
  std::size_t rows_ = 0, memories_ = 0;
};

}  // namespace

std::string block_diagram(const sim::Result& timing) {
  return Diagram(timing).svg();
}

void add_machine(Report& report, std::string_view caption, const sim::Result& timing) {
  report.diagram(caption, block_diagram(timing),
                 {{"busy", "it did something"},
                  {"starved", "nothing came"},
                  {"blocked", "another unit was in the way"},
                  {"idle", "there was nothing to do"}});
  std::vector<std::vector<std::string>> rows;
  const auto percent = [&](sim::Cycle cycles) { return fmt::format("{:.1f}", 100 * timing.share(cycles)); };
  for (const sim::UnitBooks& unit : timing.units) {
    std::string by;
    for (const auto& [who, cycles] : unit.blocked_by)
      by += fmt::format("{}{} {}", by.empty() ? "" : ", ", who, percent(cycles));
    rows.push_back({unit.name, percent(unit.busy), percent(unit.starved), percent(unit.blocked),
                    percent(unit.idle), by});
  }
  using enum Report::Align;
  report.folded_table("The shares of each unit, in % of the cycles",
                      {{"unit"},
                       {"busy", number},
                       {"starved", number},
                       {"blocked", number},
                       {"idle", number},
                       {"blocked by", prose}},
                      rows);
  for (const sim::UnitLeftOut& unit : timing.units_left_out)
    report.paragraph(fmt::format("Left out: {}, as {}.", unit.name, unit.why));
}

}  // namespace splatscope::studies
