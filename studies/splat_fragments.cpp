#include "studies/splat_fragments.h"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "kernels/reference/filter_value.h"
#include "kernels/reference/ray_plane.h"
#include "kernels/reference/surfel_filter.h"
#include "studies/reference_comparison.h"
#include "studies/run.h"
#include "traces/splat_trace.h"

namespace splatscope::studies {
namespace {

// A splat as the view sees it.
struct Splat {
  kernels::RayPlane plane;  // in units of y
  double height = 0;        // rho_k at its centre
  double reach = 0;         // furthest point of it, object units from its centre
};

class Fragments {
 public:
  Fragments(const traces::Scene& scene, const VisibleSurface& surface)
      : view_(traces::view_of(scene.camera, scene.frame)),
        surface_(surface),
        surfels_(reference_surfels(scene)),
        depth_offset_(scene.splatting.depth_offset),
        filter_(filter_of(scene)),
        splats_(surfels_.size()) {
    for (std::size_t k = 0; k < surfels_.size(); ++k)
      prepare(surfels_[k], scene.splatting.algorithm, splats_[k]);
  }

  // Nothing where the fragment is beyond the cutoff.
  std::optional<SplatFragment> fragment(std::uint32_t k, int x, int y, bool kept) const {
    if (!splats_[k]) return {};
    const kernels::RayHit hit = splats_[k]->plane(x + 0.5, y + 0.5);
    const double value = kernels::filter_value(filter_, hit.y);
    if (!(value > 0)) return {};
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) + static_cast<std::size_t>(x);
    return SplatFragment{k,
                         pixel,
                         kept,
                         hit.z <= view_.moved_back(surface_.depth[pixel], x, y, depth_offset_),
                         layer(k, pixel, hit.z),
                         value * splats_[k]->height};
  }

 private:
  void prepare(const kernels::Surfel& surfel, traces::Algorithm algorithm, std::optional<Splat>& out) const {
    const auto filter = kernels::surfel_filter(view_, surfel, algorithm != traces::Algorithm::no_ewa);
    if (!filter) return;
    const glm::dvec3 s = view_.camera_direction(surfel.tangent_s),
                     t = view_.camera_direction(surfel.tangent_t);
    const glm::dvec3 a = filter->axes[0][0] * s + filter->axes[0][1] * t;
    const glm::dvec3 b = filter->axes[1][0] * s + filter->axes[1][1] * t;
    out = Splat{kernels::RayPlane(view_, view_.camera_space(surfel.position), a, b),
                0.5 * std::numbers::inv_pi / std::sqrt(filter->determinant),
                kernels::filter_reach(filter_) * glm::length(a)};
  }

  Layer layer(std::uint32_t k, std::size_t pixel, double z) const {
    if (!std::isfinite(surface_.depth[pixel])) return Layer::visible;  // nothing else is there
    const kernels::Surfel &own = surfels_[k], &seen = surfels_[surface_.surfel[pixel]];
    const auto normal = [](const kernels::Surfel& surfel) {
      return glm::cross(surfel.tangent_s, surfel.tangent_t);
    };
    const double reach = splats_[k]->reach + std::sqrt(2.0) * glm::length(seen.tangent_s);
    if (glm::dot(normal(own), normal(seen)) > 0 && glm::distance(own.position, seen.position) <= reach)
      return Layer::visible;
    return z < surface_.depth[pixel] ? Layer::in_front : Layer::behind;
  }

  kernels::View view_;
  const VisibleSurface& surface_;
  std::vector<kernels::Surfel> surfels_;
  double depth_offset_;
  kernels::ReferenceSettings filter_;
  std::vector<std::optional<Splat>> splats_;
};

// The surfel that a triangle of a draw belongs to.
std::uint32_t surfel_of(const Trace& trace, const Draw& draw, std::size_t triangle) {
  std::uint16_t index;
  std::memcpy(
      &index,
      trace.buffers[draw.index_buffer].bytes.data() + (draw.first_index + 3 * triangle) * sizeof index,
      sizeof index);
  return (draw.base_vertex + index) / traces::kQuadVertices;
}

template <class Visit>
void visit_fragments(const Trace& trace, const Rendered& rendered, const Visit& visit) {
  for (const DrawWork& work : rendered.work) {
    const Draw& draw = std::get<Draw>(trace.commands[work.command]);
    if (!draw.state.color_write) continue;  // the visibility pass
    auto quad = work.quads.begin();
    for (std::size_t i = 0; i < work.triangles.size(); ++i) {
      const std::uint32_t surfel = surfel_of(trace, draw, i);
      for (std::uint32_t n = 0; n < work.triangles[i].quad_count; ++n, ++quad) {
        for (unsigned bit = 0; bit < 4; ++bit) {
          if ((quad->covered >> bit & 1u) == 0) continue;
          visit(surfel, 2 * quad->x + static_cast<int>(bit & 1u), 2 * quad->y + static_cast<int>(bit >> 1),
                (quad->passed >> bit & 1u) != 0);
        }
      }
    }
  }
}

}  // namespace

VisibleSurface visible_surface(const traces::Scene& scene) {
  const kernels::View view = traces::view_of(scene.camera, scene.frame);
  VisibleSurface surface{view.width, view.height, {}, {}};
  const std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  surface.depth.resize(pixels, std::numeric_limits<double>::infinity());
  surface.surfel.resize(pixels);
  const std::vector<kernels::Surfel> surfels = reference_surfels(scene);
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    const glm::dvec3 o = view.camera_space(surfels[k].position);
    const glm::dvec3 s = view.camera_direction(surfels[k].tangent_s);
    const glm::dvec3 t = view.camera_direction(surfels[k].tangent_t);
    const kernels::RayPlane quad(view, o, s, t);
    const kernels::PixelBox box = kernels::bounding_box(view, o, s, t);
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) {
        const kernels::RayHit hit = quad(x + 0.5, y + 0.5);
        if (!(std::abs(hit.y.x) <= 1 && std::abs(hit.y.y) <= 1)) continue;
        const auto pixel = static_cast<std::size_t>(y * view.width + x);
        if (!(hit.z >= view.near_plane && hit.z < surface.depth[pixel])) continue;
        surface.depth[pixel] = hit.z;
        surface.surfel[pixel] = static_cast<std::uint32_t>(k);
      }
    }
  }
  return surface;
}

bool is_inside(const VisibleSurface& surface, int x, int y) {
  return is_inside(surface.depth, surface.width, surface.height, x, y);
}

void for_each_fragment(const traces::Scene& scene, const Trace& trace, const Rendered& rendered,
                       const VisibleSurface& surface,
                       const std::function<void(const SplatFragment&)>& visit) {
  const Fragments fragments(scene, surface);
  visit_fragments(trace, rendered, [&](std::uint32_t surfel, int x, int y, bool kept) {
    if (const auto fragment = fragments.fragment(surfel, x, y, kept)) visit(*fragment);
  });
}

FragmentCounts count_fragments(const traces::Scene& scene, const Trace& trace, const Rendered& rendered,
                               const VisibleSurface& surface) {
  // What adds up at a pixel.
  struct Pixel {
    double surface = 0;       // weights of the visible surface
    double surface_kept = 0;  // of these, what the machine keeps
    bool drawn = false, leaking = false;
  };
  std::vector<Pixel> pixels(surface.depth.size());
  FragmentCounts counts;
  for_each_fragment(scene, trace, rendered, surface, [&](const SplatFragment& fragment) {
    ++counts.fragments;
    counts.kept += fragment.kept;
    counts.wrongly_hidden += fragment.kept_by_rule && !fragment.kept;
    counts.wrongly_kept += !fragment.kept_by_rule && fragment.kept;
    const bool visible = fragment.layer == Layer::visible;
    const bool leaking = fragment.layer == Layer::behind && fragment.kept;
    counts.of_surface += visible;
    counts.surface_hidden += visible && !fragment.kept;
    counts.leaking += leaking;
    Pixel& pixel = pixels[fragment.pixel];
    pixel.drawn |= fragment.kept;
    pixel.leaking |= leaking;
    if (visible) pixel.surface += fragment.weight;
    if (visible && fragment.kept) pixel.surface_kept += fragment.weight;
  });
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!std::isfinite(surface.depth[i])) continue;
    ++counts.surface_pixels;
    counts.torn_pixels += pixels[i].surface_kept < 0.5 * pixels[i].surface;
    counts.leaking_pixels += pixels[i].leaking;
  }
  for (int y = 0; y < surface.height; ++y) {
    for (int x = 0; x < surface.width; ++x) {
      if (!is_inside(surface, x, y)) continue;
      ++counts.inside_pixels;
      counts.holes += !pixels[static_cast<std::size_t>(y * surface.width + x)].drawn;
    }
  }
  return counts;
}

Image wrong_pixels(const traces::Scene& scene, const Trace& trace, const Rendered& rendered,
                   const VisibleSurface& surface) {
  Image image = picture_of(rendered.frame);
  for (auto& [r, g, b, a] : image.pixels) r = g = b = 0.25f + 0.25f * (r + g + b) / 3;
  for_each_fragment(scene, trace, rendered, surface, [&](const SplatFragment& fragment) {
    if (fragment.kept == fragment.kept_by_rule) return;
    auto& [r, g, b, a] = image.pixels[fragment.pixel];
    if (g != 0) r = g = b = 0;
    (fragment.kept ? b : r) = 1;
  });
  return image;
}

}  // namespace splatscope::studies
