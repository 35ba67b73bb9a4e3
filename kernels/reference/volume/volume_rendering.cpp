#include "kernels/reference/volume/volume_rendering.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <span>

#include "kernels/reference/volume/sheet_drawing.h"

namespace splatscope::kernels {
namespace {

glm::dvec3 ray_direction(Projection projection, const glm::dvec3& camera) {
  return projection == Projection::orthographic ? glm::dvec3(0, 0, 1) : glm::normalize(camera);
}

// A projected splat.
struct Projected {
  Footprint footprint;
  glm::dvec4 color{};  // r g b times opacity, and opacity, at the centre
  int left = 0, top = 0, right = 0, bottom = 0;
  std::uint32_t sheet = 0;
};

// First pixel whose centre is at or after x, within [0, size].
int pixel_from(double x, int size) {
  return static_cast<int>(std::clamp(std::ceil(x - 0.5), 0.0, static_cast<double>(size)));
}

// Projects the splats of one view.
class Projector {
 public:
  Projector(const View& view, const VolumeSplats& splats, const VolumeSettings& settings)
      : view_(view), splats_(splats), settings_(settings), scale_(opacity_scale(view, settings.cutoff)) {
    if (splats.kernels.size() == 1) shared_ = camera_variance(view, splats.kernels[0]);
  }

  bool project(const VolumeSplat& splat, Projected& result) const {
    const glm::dvec3 camera = view_.camera_space(splat.position);
    const glm::dvec3 turned = view_.camera_direction(splat.normal);
    const bool flat = splat.flatness > 0;
    const glm::dvec3 normal = turned == glm::dvec3(0) ? turned : glm::normalize(turned);
    glm::dmat3 variance = shared_ ? *shared_ : camera_variance(view_, splats_.kernels[splat.kernel]);
    const double s = 1 / (1 - static_cast<double>(splat.flatness));
    if (flat) variance = flattened(variance, normal, s);
    const auto print = footprint(view_, settings_.projection, settings_.prefilter, camera, variance);
    if (!print) return false;
    result.footprint = *print;
    double opacity = static_cast<double>(splat.weight) * print->peak * scale_;
    if (flat) opacity *= flattened_weight(glm::dot(normal, ray_direction(settings_.projection, camera)), s);
    result.color =
        opacity * glm::dvec4(shaded(settings_.light, settings_.projection, camera, normal, splat.color), 1);
    const glm::dvec2 reach = print->reach(settings_.cutoff), center = print->center;
    result.left = pixel_from(center.x - reach.x, view_.width);
    result.right = pixel_from(center.x + reach.x, view_.width);
    result.top = pixel_from(center.y - reach.y, view_.height);
    result.bottom = pixel_from(center.y + reach.y, view_.height);
    return result.left < result.right && result.top < result.bottom;
  }

 private:
  const View& view_;
  const VolumeSplats& splats_;
  const VolumeSettings& settings_;
  double scale_;
  std::optional<glm::dmat3> shared_;
};

// The rows of a band: a sheet, and where it goes.
class Band {
 public:
  Band(RowRange rows, double cutoff, VolumePicture& picture)
      : rows_(rows), cutoff_(cutoff), picture_(&picture), sheet_(size(rows)) {}

  void add(std::span<const Projected> splats, std::span<const std::uint32_t> order) {
    for (const std::uint32_t k : order) {
      const Projected& splat = splats[k];
      for (int row = std::max(splat.top, rows_.top); row < std::min(splat.bottom, rows_.bottom); ++row) {
        for (int column = splat.left; column < splat.right; ++column) {
          const double r = splat.footprint.radial_index({column + 0.5, row + 0.5});
          if (r < cutoff_) sheet_[index(row - rows_.top, column)] += std::exp(-0.5 * r) * splat.color;
        }
      }
    }
  }

  void composite() {
    glm::dvec4* pixel = picture_->pixels.data() + index(rows_.top, 0);
    for (glm::dvec4& sums : sheet_) {
      if (sums.w > 0) {
        const glm::dvec4 front = sums / std::max(1.0, sums.w);
        *pixel = front + (1 - front.w) * *pixel;
        sums = {};
      }
      ++pixel;
    }
  }

 private:
  std::size_t size(RowRange rows) const { return index(rows.bottom - rows.top, 0); }
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(picture_->width) +
           static_cast<std::size_t>(column);
  }

  RowRange rows_;
  double cutoff_;
  VolumePicture* picture_;
  std::vector<glm::dvec4> sheet_;
};

}  // namespace

double opacity_scale(const View& view, double cutoff) {
  const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(view.object_to_camera))));
  return 1 / (scale * (1 - std::exp(-0.5 * cutoff)));
}

glm::dvec3 shaded(const PhongLight& light, Projection projection, const glm::dvec3& camera,
                  const glm::dvec3& camera_normal, const glm::dvec3& color) {
  double matt = light.ambient + light.diffuse, shine = 0;
  if (camera_normal != glm::dvec3(0)) {
    const glm::dvec3 half = light.toward_light - ray_direction(projection, camera);
    matt = light.ambient + light.diffuse * std::abs(glm::dot(camera_normal, light.toward_light));
    const double cosine = std::abs(glm::dot(camera_normal, half)) / std::max(glm::length(half), 1e-12);
    shine = light.specular * std::pow(std::min(cosine, 1.0), light.shininess);
  }
  return glm::min(matt * color + shine, 1.0);
}

VolumePicture volume_picture(const View& view, const VolumeSplats& splats, const VolumeSettings& settings,
                             const std::function<void(double)>& progress) {
  VolumePicture picture{view.width, view.height, {}, splats.splats.size(), 0};
  picture.pixels.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  std::vector<Band> bands;
  for (int top = 0; top < view.height; top += RowBands::kRows) {
    bands.emplace_back(RowRange{top, std::min(view.height, top + RowBands::kRows)}, settings.cutoff, picture);
  }
  const SheetAxis axis = sheet_axis(view, splats, settings.axis);
  const SheetOrder order = sheet_order(splats, axis.axis);
  const Projector projector(view, splats, settings);
  const SheetsDrawn drawn =
      draw_sheets<Projected>(view, order, axis.last_is_nearest, bands, progress,
                             [&](std::span<const std::uint32_t> numbers,
                                 std::span<const std::uint32_t> sheets, Projected* out, RowRange* rows) {
                               std::size_t kept = 0;
                               for (std::size_t i = 0; i < numbers.size(); ++i) {
                                 if (!projector.project(splats.splats[numbers[i]], out[kept])) continue;
                                 out[kept].sheet = sheets[i];
                                 rows[kept] = {out[kept].top, out[kept].bottom};
                                 ++kept;
                               }
                               return kept;
                             });
  picture.left_out -= drawn.splats;
  picture.sheets = drawn.sheets;
  return picture;
}

}  // namespace splatscope::kernels
