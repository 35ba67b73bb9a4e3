#include "kernels/reference/screen_space.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "kernels/reference/ray_plane.h"
#include "kernels/reference/row_bands.h"

namespace splatscope::kernels {
namespace {

enum class Fate : std::uint8_t { drawn, skipped, culled };

// A surfel as one view sees it.
struct Splat {
  Fate fate = Fate::skipped;
  PixelBox quad_box, box;
  RayPlane quad;                // y is u of the opaque quad
  RayPlane plane;               // y is the filter's, of the perspective map
  glm::dvec2 center{};          // x_k, pixels
  glm::dmat2 to_filter{0.0};    // y = to_filter (x - x_k): the affine map
  glm::dvec4 weighted_color{};  // s_k/(2 pi r0 r1) times (w_k, 1)
};

PixelBox intersection(const PixelBox& box, const RowRange& rows) {
  return {box.left, std::max(box.top, rows.top), box.right, std::min(box.bottom, rows.bottom)};
}

class Renderer {
 public:
  Renderer(const View& view, const ScreenSpaceSettings& settings) : view_(view), settings_(settings) {
    const std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    picture_.width = view.width;
    picture_.height = view.height;
    picture_.depth_offset = settings.depth_offset;
    picture_.sums.resize(pixels);
    picture_.normalized.resize(pixels);
    picture_.depth.resize(pixels, std::numeric_limits<double>::infinity());
  }

  ScreenSpacePicture draw(std::span<const Surfel> surfels) {
    std::vector<Splat> splats(surfels.size());
    const RowBands bands(view_.height, surfels.size(),
                         [&](std::size_t begin, std::size_t end, RowRange* rows) {
                           for (std::size_t k = begin; k < end; ++k) {
                             splats[k] = prepare(surfels[k]);
                             rows[k - begin] = {std::min(splats[k].quad_box.top, splats[k].box.top),
                                                std::max(splats[k].quad_box.bottom, splats[k].box.bottom)};
                           }
                           return end - begin;
                         });
    const auto for_each_splat = [&](int band, const auto& visit) {
      bands.for_each_run(band, [&](std::span<const std::uint32_t> run) {
        for (const std::uint32_t k : run) visit(splats[k]);
      });
    };
    bands.for_each_band([&](int band) {
      const RowRange rows = bands.rows(band);
      for_each_splat(band, [&](const Splat& splat) { draw_quad(splat, rows); });
      for_each_splat(band, [&](const Splat& splat) { add_splat(splat, rows); });
      for (std::size_t i = index(rows.top, 0); i < index(rows.bottom, 0); ++i) {
        picture_.normalized[i] = normalized_color(picture_.sums[i]);
      }
    });
    const auto count = [&](Fate fate) {
      return static_cast<std::size_t>(
          std::ranges::count_if(splats, [&](const Splat& splat) { return splat.fate == fate; }));
    };
    picture_.skipped = count(Fate::skipped);
    picture_.culled = count(Fate::culled);
    return std::move(picture_);
  }

 private:
  Splat prepare(const Surfel& surfel) const {
    Splat splat;
    const glm::dvec3 o = view_.camera_space(surfel.position);
    const glm::dvec3 s = view_.camera_direction(surfel.tangent_s);
    const glm::dvec3 t = view_.camera_direction(surfel.tangent_t);
    if (settings_.cull_back_faces && glm::dot(glm::cross(s, t), o) > 0) {
      splat.fate = Fate::culled;
      return splat;
    }
    const std::optional<SurfelFilter> filter = surfel_filter(view_, surfel, settings_.filter.prefilter);
    if (!filter) return splat;
    splat.fate = Fate::drawn;
    splat.quad_box = bounding_box(view_, o, s, t);
    splat.quad = RayPlane(view_, o, s, t);
    const double reach = filter_reach(settings_.filter);
    if (settings_.map == ScreenMap::perspective) {
      const glm::dvec3 a = filter->axes[0][0] * s + filter->axes[0][1] * t;
      const glm::dvec3 b = filter->axes[1][0] * s + filter->axes[1][1] * t;
      splat.plane = RayPlane(view_, o, a, b);
      splat.box = bounding_box(view_, o, reach * a, reach * b);
    } else {
      const glm::dmat2 to_screen = filter->jacobian * filter->axes;
      splat.to_filter = glm::inverse(to_screen);
      splat.center = view_.window(o);
      splat.box = box_about(view_, splat.center, reach * (glm::abs(to_screen[0]) + glm::abs(to_screen[1])));
    }
    const double height = surfel.weight * 0.5 * std::numbers::inv_pi / std::sqrt(filter->determinant);
    splat.weighted_color = height * glm::dvec4(surfel.color, 1.0);
    return splat;
  }

  void draw_quad(const Splat& splat, const RowRange& rows) {
    const PixelBox box = intersection(splat.quad_box, rows);
    for (int row = box.top; row < box.bottom; ++row) {
      for (int column = box.left; column < box.right; ++column) {
        const RayHit hit = splat.quad(column + 0.5, row + 0.5);
        if (!(std::abs(hit.y.x) <= 1 && std::abs(hit.y.y) <= 1)) continue;
        if (!(hit.z >= view_.near_plane &&
              view_.moved_back(hit.z, column, row, settings_.depth_offset) <= view_.far_plane))
          continue;
        double& nearest = picture_.depth[index(row, column)];
        nearest = std::min(nearest, hit.z);
      }
    }
  }

  void add_splat(const Splat& splat, const RowRange& rows) {
    const PixelBox box = intersection(splat.box, rows);
    for (int row = box.top; row < box.bottom; ++row) {
      for (int column = box.left; column < box.right; ++column) {
        const glm::dvec2 x{column + 0.5, row + 0.5};
        const bool affine = settings_.map == ScreenMap::affine;
        const RayHit hit = affine ? splat.quad(x.x, x.y) : splat.plane(x.x, x.y);
        const double value =
            filter_value(settings_.filter, affine ? splat.to_filter * (x - splat.center) : hit.y);
        if (!(value > 0) || !(hit.z >= view_.near_plane && hit.z <= view_.far_plane)) continue;
        if (hit.z > view_.moved_back(picture_.depth[index(row, column)], column, row, settings_.depth_offset))
          continue;
        picture_.sums[index(row, column)] += value * splat.weighted_color;
      }
    }
  }

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.width) +
           static_cast<std::size_t>(column);
  }

  const View& view_;
  const ScreenSpaceSettings& settings_;
  ScreenSpacePicture picture_;
};

}  // namespace

ScreenSpacePicture screen_space_ewa(const View& view, std::span<const Surfel> surfels,
                                    const ScreenSpaceSettings& settings) {
  return Renderer(view, settings).draw(surfels);
}

}  // namespace splatscope::kernels
