#include <fmt/format.h>

#include "studies/precision.h"

namespace splatscope::studies {
namespace {

using traces::Algorithm;

// The switches as a table is read: step by step, from coarse to fine.
class List {
 public:
  // `machine`: the level that the GeForce4 has.
  template <class Value, class Turn>
  void add(std::string_view step, std::initializer_list<Value> levels, std::string_view machine, Turn turn) {
    for (const Value& level : levels) {
      add_one(step, fmt::format("{}", level), machine, [=](Pipeline& p) { turn(p, level); });
    }
  }
  void add_one(std::string_view step, const std::string& level, std::string_view machine,
               std::function<void(Pipeline&)> turn, bool in_full = false) {
    switches_.push_back({std::string(step), level, level == machine, in_full, std::move(turn)});
  }
  std::vector<Switch> take() { return std::move(switches_); }

 private:
  std::vector<Switch> switches_;
};

void add_texture(List& list) {
  list.add("texel bits", {4, 5, 6, 7, 8, 10, 12, 16}, "8",
           [](Pipeline& p, int bits) { p.texel_bits = bits; });
  list.add("texture size", {16, 32, 64, 128, 256, 438, 1024}, "438", [](Pipeline& p, int size) {
    p.texture_size = size;
    p.numbers.filter_bits = 0;
  });
  list.add("size, bilinear", {8, 16, 32, 64, 128, 438}, "", [](Pipeline& p, int size) {
    p.texture_size = size;
    p.numbers.filter_bits = 8;
  });
  list.add("bilinear bits", {4, 5, 6, 8}, "", [](Pipeline& p, int bits) {
    p.texture_size = 64;
    p.numbers.filter_bits = bits;
  });
  for (const bool circular : {true, false}) {
    for (const double cutoff : {0.5, 1.0, 2.0, 4.0}) {
      list.add_one(
          circular ? "circle, c" : "square, c", fmt::format("{}", cutoff), circular ? "1" : "",
          [=](Pipeline& p) {
            p.cutoff = cutoff;
            p.circular = circular;
          },
          true);
    }
  }
}

void add_colors(List& list) {
  list.add_one("diffuse", "8 bits", "8 bits", [](Pipeline& p) { p.numbers.color = ColorFormat::unorm8; });
  list.add_one("diffuse", "12 bits", "", [](Pipeline& p) { p.numbers.color = ColorFormat::unorm12; });
  list.add_one("diffuse", "float", "", [](Pipeline& p) { p.numbers.color = ColorFormat::float32; });
  list.add_one("combiner", "9 bits", "9 bits",
               [](Pipeline& p) { p.numbers.combiner = CombinerFormat::signed9; });
  list.add_one("combiner", "float", "", [](Pipeline& p) { p.numbers.combiner = CombinerFormat::float32; });
  const auto frame = [&](const std::string& level, FrameFormat format, FrameRounding rounding) {
    list.add_one("frame", level, "8 bits", [=](Pipeline& p) {
      p.numbers.frame = format;
      p.numbers.frame_rounding = rounding;
    });
  };
  frame("8 bits, truncated", FrameFormat::unorm8, FrameRounding::truncate);
  frame("8 bits, dithered", FrameFormat::unorm8, FrameRounding::dither);
  frame("8 bits", FrameFormat::unorm8, FrameRounding::nearest);
  frame("10 bits", FrameFormat::unorm10, FrameRounding::nearest);
  frame("half", FrameFormat::half, FrameRounding::nearest);
  frame("16 bits", FrameFormat::unorm16, FrameRounding::nearest);
  frame("float", FrameFormat::float32, FrameRounding::nearest);
}

void add_geometry(List& list) {
  list.add_one("depth", "z16", "", [](Pipeline& p) { p.numbers.depth = DepthFormat::z16; });
  list.add_one("depth", "z24", "z24", [](Pipeline& p) { p.numbers.depth = DepthFormat::z24; });
  list.add_one("depth", "float", "", [](Pipeline& p) { p.numbers.depth = DepthFormat::float32; });
  list.add("RCP, RSQ bits", {8, 10, 12, 14, 16, 20, 24}, "", [](Pipeline& p, int bits) {
    p.numbers.vertex_arithmetic = Arithmetic::ieee;
    p.numbers.reciprocal_bits = bits;
  });
  list.add_one("arithmetic", "nv20", "nv20",
               [](Pipeline& p) { p.numbers.vertex_arithmetic = Arithmetic::nv20; });
  list.add_one("arithmetic", "ieee", "", [](Pipeline& p) { p.numbers.vertex_arithmetic = Arithmetic::ieee; });
  list.add("sub-pixel bits", {0, 1, 2, 3, 4, 6, 8}, "4",
           [](Pipeline& p, int bits) { p.numbers.subpixel_bits = bits; });
}

void add_weights(List& list) {
  list.add("gamma, per pixel", {0.4, 0.5, 0.6, 0.73, 0.85, 1.0}, "0.73",
           [](Pipeline& p, double g) { p.gamma = g; });
  const auto surfel = [&](const std::string& level, bool corners, double gamma) {
    list.add_one(gamma > 0 ? "gamma, per surfel" : "weights", level, "", [=](Pipeline& p) {
      p.algorithm = Algorithm::ewa_per_surfel;
      p.corner_weights = corners;
      p.gamma = gamma;
    });
  };
  for (const double gamma : {0.4, 0.5, 0.6, 0.73, 0.85, 1.0}) surfel(fmt::format("{}", gamma), true, gamma);
  list.add_one("weights", "divided per pixel", "divided per pixel", [](Pipeline&) {});
  surfel("folded in, a corner", true, 0);
  surfel("folded in, a surfel", false, 0);
}

}  // namespace

std::vector<Switch> precision_switches() {
  List list;
  list.add_one("nothing", "", "", [](Pipeline&) {});
  add_texture(list);
  add_colors(list);
  add_geometry(list);
  add_weights(list);
  return list.take();
}

}  // namespace splatscope::studies
