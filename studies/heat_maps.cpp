#include "studies/heat_maps.h"

#include <algorithm>
#include <cmath>

namespace splatscope::studies {
namespace {

constexpr std::uint32_t kQuad = 2;  // pixels

GrayImage blank(std::uint32_t width, std::uint32_t height) {
  return {static_cast<int>(width), static_cast<int>(height), std::vector<float>(std::size_t{width} * height)};
}

HeatMap map_of(const char* name, const char* unit, const char* what, const char* counter, std::uint32_t scale,
               const Trace& trace) {
  return {name,
          unit,
          what,
          counter,
          static_cast<int>(scale),
          blank((trace.width + scale - 1) / scale, (trace.height + scale - 1) / scale)};
}

void count(HeatMap& map, std::uint32_t x, std::uint32_t y, std::uint32_t more) {
  map.image.pixels[std::size_t{y} * static_cast<std::size_t>(map.image.width) + x] +=
      static_cast<float>(more);
  map.sum += more;
}

}  // namespace

HeatMaps::HeatMaps(const Trace& trace, bool cycles)
    : trace_(trace),
      overdraw_(map_of("overdraw", "fragments", "triangles that cover the pixel", "fragments", 1, trace)),
      depth_fails_(map_of("depth_fails", "fragments", "of these, those that failed the depth test",
                          "fragments - fragments_passed", 1, trace)),
      texel_fetches_(map_of("texel_fetches", "blocks",
                            "distinct 4x4-texel blocks that the 2x2 pixels read, by each triangle",
                            "texture.lookups", kQuad, trace)) {
  if (cycles) tiles_.emplace(trace.width, trace.height);
}

void HeatMaps::add(const DrawWork& work) {
  for (const QuadWork& quad : work.quads) {
    for (std::uint32_t bit = 0; bit < 4; ++bit) {
      if ((quad.covered >> bit & 1) == 0) continue;
      const std::uint32_t x = quad.x * kQuad + (bit & 1), y = quad.y * kQuad + (bit >> 1);
      count(overdraw_, x, y, 1);
      if ((quad.passed >> bit & 1) == 0) count(depth_fails_, x, y, 1);
    }
    count(texel_fetches_, quad.x, quad.y, quad.texel_block_count);
  }
}

std::vector<HeatMap> HeatMaps::maps() const {
  std::vector<HeatMap> maps{overdraw_, depth_fails_, texel_fetches_};
  if (!tiles_) return maps;
  HeatMap cycles =
      map_of("cycles_per_tile", "cycles",
             "core cycles that the rasteriser was at the 8x8-pixel tile, waiting for others or not",
             "raster: busy + starved + blocked", sim::TileCycles::kTile, trace_);
  for (std::uint32_t y = 0; y < tiles_->rows(); ++y) {
    for (std::uint32_t x = 0; x < tiles_->columns(); ++x) {
      const sim::Cycle here = tiles_->cycles()[std::size_t{y} * tiles_->columns() + x];
      cycles.image.pixels[std::size_t{y} * tiles_->columns() + x] = static_cast<float>(here);
      cycles.sum += here;
    }
  }
  maps.push_back(std::move(cycles));
  return maps;
}

Image colored(const HeatMap& map) {
  // As matplotlib's inferno, at five places.
  constexpr float kColors[][3] = {
      {0, 0, 0.02f}, {0.34f, 0.06f, 0.43f}, {0.74f, 0.22f, 0.33f}, {0.98f, 0.56f, 0.04f}, {0.99f, 1, 0.64f}};
  const GrayImage& counts = map.image;
  const float most = *std::ranges::max_element(counts.pixels);
  Image image(counts.width * map.scale, counts.height * map.scale);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int from = y / map.scale * counts.width + x / map.scale;
      const float value = counts.pixels[static_cast<std::size_t>(from)];
      const float place = most > 0 ? 4 * std::log1p(value) / std::log1p(most) : 0;
      const auto below = static_cast<std::size_t>(std::min(place, 3.0f));
      const float part = place - static_cast<float>(below);
      for (std::size_t c = 0; c < 3; ++c)
        image.at(x, y)[c] = (1 - part) * kColors[below][c] + part * kColors[below + 1][c];
      image.at(x, y)[3] = 1;
    }
  }
  return image;
}

}  // namespace splatscope::studies
