#include "studies/reference_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/error.h"
#include "traces/splat_trace.h"

namespace splatscope::studies {
namespace {

// Of the summed weights where there are any.
double median_weight(const kernels::SplatSums& reference) {
  std::vector<double> weights;
  for (const glm::dvec4& sum : reference.sums) {
    if (sum.w > 0) weights.push_back(sum.w);
  }
  if (weights.empty()) return 0;
  const auto middle = weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2);
  std::ranges::nth_element(weights, middle);
  return *middle;
}

kernels::ReferenceSettings filter_of(const traces::Scene& scene) {
  return {
      .prefilter = true,
      .cutoff = scene.splatting.cutoff,
      .shape = scene.splatting.circular_cutoff ? kernels::CutoffShape::circle : kernels::CutoffShape::square};
}

// All of a Comparison but its holes.
Comparison surface_difference(const Frame& frame, const kernels::SplatSums& reference) {
  const double half = 0.5 * median_weight(reference);
  Comparison out;
  double squares = 0;
  for (std::size_t pixel = 0; pixel < reference.sums.size(); ++pixel) {
    if (!(reference.sums[pixel].w > 0) || reference.sums[pixel].w < half) continue;
    ++out.surface_pixels;
    const Vec4 color = frame.color(pixel);
    double largest = 0;
    for (int c = 0; c < 3; ++c) {
      const double difference =
          std::clamp(double{color[static_cast<std::size_t>(c)]}, 0.0, 1.0) - reference.normalized[pixel][c];
      squares += difference * difference;
      largest = std::max(largest, std::abs(difference));
    }
    out.worst = std::max(out.worst, 255 * largest);
    out.over_8 += 255 * largest > 8;
  }
  out.psnr = -10 * std::log10(squares / (3.0 * static_cast<double>(out.surface_pixels)));
  return out;
}

std::size_t pixel_index(const kernels::SplatSums& reference, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(reference.width) +
         static_cast<std::size_t>(x);
}

bool is_inside(const kernels::ScreenSpacePicture& reference, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (!std::isfinite(reference.depth[pixel_index(reference, x + dx, y + dy)])) return false;
    }
  }
  return true;
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

kernels::ReferencePicture scene_reference(const traces::Scene& scene, const Leave& leave) {
  kernels::ReferenceSettings settings = filter_of(scene);
  settings.cutoff_tolerance = leave.cutoff_tolerance;
  settings.edge_tolerance = leave.edge_tolerance;
  settings.texture_length = leave.eight_bit_texels ? traces::texture_length(scene.splatting) : 0;
  return kernels::ewa_reference(traces::view_of(scene.camera, scene.frame), reference_surfels(scene),
                                settings);
}

kernels::ScreenMap screen_map_by_name(std::string_view name) {
  if (name == "affine") return kernels::ScreenMap::affine;
  if (name == "perspective") return kernels::ScreenMap::perspective;
  throw UserError("--reference", 0, fmt::format("unknown map \"{}\", expected affine or perspective", name));
}

kernels::ScreenSpacePicture screen_space_reference(const traces::Scene& scene, kernels::ScreenMap map) {
  return kernels::screen_space_ewa(traces::view_of(scene.camera, scene.frame), reference_surfels(scene),
                                   {.filter = filter_of(scene),
                                    .map = map,
                                    .depth_offset = scene.splatting.depth_offset,
                                    .cull_back_faces = scene.splatting.faces == traces::Faces::front});
}

double psnr(const Frame& frame, const kernels::SplatSums& reference) {
  return surface_difference(frame, reference).psnr;
}

Comparison compare(const Frame& frame, const kernels::ScreenSpacePicture& reference) {
  Comparison out = surface_difference(frame, reference);
  for (int y = 1; y + 1 < reference.height; ++y) {
    for (int x = 1; x + 1 < reference.width; ++x) {
      if (!is_inside(reference, x, y)) continue;
      ++out.inside_pixels;
      out.holes += frame.color(pixel_index(reference, x, y)) == Vec4{};
    }
  }
  return out;
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
      value = std::clamp(0.5f + kGain * (color[c] - value), 0.0f, 1.0f);
    }
  }
  return image;
}

SurfaceAgreement agreement(const Frame& frame, const kernels::ReferencePicture& reference) {
  const double half = 0.5 * median_weight(reference);
  SurfaceAgreement both;
  for (std::size_t pixel = 0; pixel < reference.coverage.size(); ++pixel) {
    if (reference.coverage[pixel] != kernels::Coverage::certain) continue;
    Agreement& out = reference.sums[pixel].w < half ? both.fringe : both.surface;
    ++out.pixels;
    out.with_ties += reference.lowest[pixel] != reference.highest[pixel];
    const Vec4 color = frame.color(pixel);
    double distance = 0;  // 1/255
    for (int c = 0; c < 3; ++c) {
      const double value = color[static_cast<std::size_t>(c)];
      distance = std::max({distance, 255 * (reference.lowest[pixel][c] - value),
                           255 * (value - reference.highest[pixel][c])});
    }
    out.outside += distance > 0.5;
    out.worst = std::max(out.worst, distance);
  }
  return both;
}

}  // namespace splatscope::studies
