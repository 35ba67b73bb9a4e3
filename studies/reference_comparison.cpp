#include "studies/reference_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <span>

#include "model/error.h"
#include "traces/median.h"
#include "traces/splat_trace.h"

namespace splatscope::studies {

double median_weight(const kernels::SplatSums& reference) {
  std::vector<double> weights;
  for (const glm::dvec4& sum : reference.sums) {
    if (sum.w > 0) weights.push_back(sum.w);
  }
  return traces::median(std::span(weights));
}

namespace {

constexpr double kHalfStep = 0.5 / 255;  // of 8 bits

// Mean square of differences as decibels.
struct SquareSum {
  std::size_t pixels = 0;
  double squares = 0;  // of three channels a pixel
  double psnr() const { return decibels(squares, 3 * pixels); }
};

// Of the frame's channels from the reference's.
glm::dvec3 difference(const Frame& frame, const kernels::SplatSums& reference, std::size_t pixel) {
  const Vec4 color = frame.color(pixel);
  const glm::dvec3 shown(color[0], color[1], color[2]);
  return glm::clamp(shown, 0.0, 1.0) - reference.normalized[pixel];
}

// All of a Comparison that needs no depth. `off_edge` says which pixels are, or is empty.
Comparison surface_difference(const Frame& frame, const kernels::SplatSums& reference,
                              const std::vector<char>& off_edge) {
  const double half = 0.5 * median_weight(reference);
  Comparison out;
  SquareSum all, inner;
  for (std::size_t pixel = 0; pixel < reference.sums.size(); ++pixel) {
    if (!(reference.sums[pixel].w > 0) || reference.sums[pixel].w < half) continue;
    const glm::dvec3 d = difference(frame, reference, pixel);
    for (SquareSum* sum : {&all, &inner}) {
      if (sum == &inner && (off_edge.empty() || !off_edge[pixel])) continue;
      ++sum->pixels;
      sum->squares += d.r * d.r + d.g * d.g + d.b * d.b;
    }
    const double largest = 255 * std::max({std::abs(d.r), std::abs(d.g), std::abs(d.b)});
    out.worst = std::max(out.worst, largest);
    out.over_8 += largest > 8;
  }
  out.surface_pixels = all.pixels;
  out.psnr = all.psnr();
  out.pixels_off_edges = inner.pixels;
  out.psnr_off_edges = inner.psnr();
  return out;
}

std::size_t pixel_index(const kernels::SplatSums& reference, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(reference.width) +
         static_cast<std::size_t>(x);
}

// Whether the depth image ends or jumps between two pixels beside each other.
bool jumps(const kernels::ScreenSpacePicture& reference, double a, double b) {
  return !(std::abs(a - b) <= 2 * reference.depth_offset);  // also where one or both are infinite
}

// Pixels that have no edge within kEdgeReach of them. The frame's border is one.
std::vector<char> off_edges(const kernels::ScreenSpacePicture& reference) {
  constexpr int kEdgeReach = 4;
  const int width = reference.width, height = reference.height;
  const auto depth = [&](int x, int y) { return reference.depth[pixel_index(reference, x, y)]; };
  std::vector<char> edge(reference.depth.size());
  const auto mark = [&](int x, int y, int i, int j) {  // x, y and its neighbour i, j to the right or below
    const bool border = x < 0 || y < 0 || i == width || j == height;
    if (!border && !jumps(reference, depth(x, y), depth(i, j))) return;
    if (x >= 0 && y >= 0) edge[pixel_index(reference, x, y)] = 1;
    if (i < width && j < height) edge[pixel_index(reference, i, j)] = 1;
  };
  for (int y = 0; y < height; ++y)
    for (int x = -1; x < width; ++x) mark(x, y, x + 1, y);
  for (int y = -1; y < height; ++y)
    for (int x = 0; x < width; ++x) mark(x, y, x, y + 1);
  std::vector<char> off(edge.size(), 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!edge[pixel_index(reference, x, y)]) continue;
      for (int j = std::max(0, y - kEdgeReach); j < std::min(height, y + kEdgeReach + 1); ++j)
        for (int i = std::max(0, x - kEdgeReach); i < std::min(width, x + kEdgeReach + 1); ++i)
          off[pixel_index(reference, i, j)] = 0;
    }
  }
  return off;
}

bool is_black(const Vec4& color) {
  return color[0] == 0 && color[1] == 0 && color[2] == 0;
}

}  // namespace

std::vector<kernels::Surfel> reference_surfels(const traces::Scene& scene) {
  std::vector<kernels::Surfel> surfels;
  surfels.reserve(scene.surfels.size());
  for (const traces::Surfel& surfel : scene.surfels) {
    const auto [s, t] = traces::tangents(surfel);
    surfels.push_back({glm::dvec3(surfel.position), s, t, scene.splatting.sigma, scene.splatting.gamma,
                       glm::dvec3(surfel.color)});
  }
  return surfels;
}

kernels::ReferenceSettings filter_of(const traces::Scene& scene) {
  return {
      .prefilter = true,
      .cutoff = scene.splatting.cutoff,
      .shape = scene.splatting.circular_cutoff ? kernels::CutoffShape::circle : kernels::CutoffShape::square};
}

kernels::SplatSums single_surface_reference(const traces::Scene& scene) {
  return kernels::screen_space_ewa(traces::view_of(scene.camera, scene.frame), reference_surfels(scene),
                                   {.filter = filter_of(scene),
                                    .map = kernels::ScreenMap::perspective,
                                    .depth_offset = std::numeric_limits<double>::infinity()});
}

kernels::ScreenMap screen_map_by_name(std::string_view name) {
  if (name == "affine") return kernels::ScreenMap::affine;
  if (name == "perspective") return kernels::ScreenMap::perspective;
  throw UserError("--reference", 0, fmt::format("unknown map \"{}\", expected affine or perspective", name));
}

kernels::ScreenSpacePicture screen_space_reference(const traces::Scene& scene, kernels::ScreenMap map) {
  return screen_space_reference(scene, reference_surfels(scene), map);
}

kernels::ScreenSpacePicture screen_space_reference(const traces::Scene& scene,
                                                   std::span<const kernels::Surfel> surfels,
                                                   kernels::ScreenMap map) {
  return kernels::screen_space_ewa(traces::view_of(scene.camera, scene.frame), surfels,
                                   {.filter = filter_of(scene),
                                    .map = map,
                                    .depth_offset = scene.splatting.depth_offset,
                                    .cull_back_faces = scene.splatting.faces == traces::Faces::front});
}

kernels::ScreenSpacePicture volume_reference(const traces::VolumeScene& scene) {
  const kernels::VolumePicture picture = volume_picture(scene.view, scene.splats(), scene.settings);
  kernels::ScreenSpacePicture reference;
  reference.width = picture.width;
  reference.height = picture.height;
  for (const glm::dvec4& pixel : picture.pixels) {
    reference.sums.emplace_back(glm::dvec3(pixel), pixel.w > kHalfStep ? 1 : 0);
    reference.normalized.push_back(glm::min(glm::dvec3(pixel) + (1 - pixel.w) * scene.background, 1.0));
  }
  reference.depth.assign(picture.pixels.size(), std::numeric_limits<double>::infinity());
  return reference;
}

double psnr(const Frame& frame, const kernels::SplatSums& reference) {
  return surface_difference(frame, reference, {}).psnr;
}

bool is_inside(std::span<const double> depth, int width, int height, int x, int y) {
  if (x < 1 || y < 1 || x + 1 >= width || y + 1 >= height) return false;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (!std::isfinite(depth[static_cast<std::size_t>((y + dy) * width + x + dx)])) return false;
    }
  }
  return true;
}

Comparison compare(const Frame& frame, const kernels::ScreenSpacePicture& reference,
                   const std::function<Frame()>& unrounded) {
  Comparison out = surface_difference(frame, reference, off_edges(reference));
  std::vector<std::size_t> empty;  // black and without weight
  for (int y = 0; y < reference.height; ++y) {
    for (int x = 0; x < reference.width; ++x) {
      if (!is_inside(reference.depth, reference.width, reference.height, x, y)) continue;
      ++out.inside_pixels;
      const std::size_t pixel = pixel_index(reference, x, y);
      const glm::dvec3& expected = reference.normalized[pixel];
      const bool shows = std::max({expected.r, expected.g, expected.b}) > kHalfStep;
      if (!shows || !is_black(frame.color(pixel))) continue;
      if (frame.color(pixel)[3] == 0) {
        empty.push_back(pixel);
      } else {
        ++out.rounded_to_black;
      }
    }
  }
  out.holes = empty.size();
  if (unrounded && !empty.empty()) {
    const Frame exact = unrounded();
    out.holes = static_cast<std::size_t>(
        std::ranges::count_if(empty, [&](std::size_t pixel) { return exact.color(pixel) == Vec4{}; }));
  }
  out.rounded_to_black += empty.size() - out.holes;
  return out;
}

nlohmann::ordered_json json_of(const Comparison& c) {
  return {{"psnr_decibels", c.psnr},
          {"surface_pixels", c.surface_pixels},
          {"psnr_off_edges_decibels", c.psnr_off_edges},
          {"pixels_off_edges", c.pixels_off_edges},
          {"worst", c.worst},
          {"pixels_over_8", c.over_8},
          {"inside_pixels", c.inside_pixels},
          {"holes", c.holes},
          {"rounded_to_black", c.rounded_to_black}};
}

std::string describe_psnr(const Comparison& comparison) {
  if (comparison.surface_pixels == 0) return "no pixel is covered";
  return fmt::format("PSNR {:.1f} dB over {} pixels", comparison.psnr, comparison.surface_pixels);
}

Image picture_of(const kernels::SplatSums& reference) {
  Image image(reference.width, reference.height);
  for (std::size_t pixel = 0; pixel < image.pixels.size(); ++pixel) {
    const glm::vec3 color(reference.normalized[pixel]);
    image.pixels[pixel] = {color.r, color.g, color.b, 1};
  }
  return image;
}

Image difference_picture(const Frame& frame, const kernels::SplatSums& reference) {
  constexpr float kGain = 16;
  Image image = picture_of(reference);
  for (std::size_t pixel = 0; pixel < image.pixels.size(); ++pixel) {
    const Vec4 color = frame.color(pixel);
    for (std::size_t c = 0; c < 3; ++c) {
      float& value = image.pixels[pixel][c];
      value = std::clamp(0.5f + kGain * (std::clamp(color[c], 0.0f, 1.0f) - value), 0.0f, 1.0f);
    }
  }
  return image;
}

}  // namespace splatscope::studies
