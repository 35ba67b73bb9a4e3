#include "kernels/reference/volume/fast_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <utility>

#include "kernels/reference/volume/sheet_drawing.h"

namespace splatscope::kernels {
namespace {

// `adjugate`: of v.
FastVariance fast_variance(const glm::dmat3& v, const glm::dmat3& adjugate) {
  FastVariance fast;
  std::size_t i = 0;
  for (const glm::dmat3* m : {&v, &adjugate}) {
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column) fast[i++] = static_cast<float>((*m)[column][row]);
  }
  return fast;
}

glm::dmat3 adjugate(const glm::dmat3& symmetric) {
  const auto& [x, y, z] = std::array{symmetric[0], symmetric[1], symmetric[2]};
  return {glm::cross(y, z), glm::cross(z, x), glm::cross(x, y)};
}

bool is_spherical(const glm::dmat3& v) {
  return v == glm::dmat3(v[0][0]);
}

FastVolumeView fast_view(const View& view, const VolumeSettings& settings, const VolumeSplats& splats,
                         bool flat) {
  FastVolumeView fast(view);
  for (int i = 0; i < 3; ++i) fast.toward_light[i] = static_cast<float>(settings.light.toward_light[i]);
  const double volume = std::abs(glm::determinant(glm::dmat3(view.object_to_camera)));
  fast.normal_scale = static_cast<float>(1 / std::cbrt(volume));
  fast.perspective = settings.projection == Projection::perspective;
  fast.prefilter = settings.prefilter;
  fast.opacity_scale =
      static_cast<float>(opacity_scale(view, settings.cutoff) * volume * 0.5 * std::numbers::inv_pi);
  fast.reach = static_cast<float>(std::sqrt(settings.cutoff));
  fast.ambient = static_cast<float>(settings.light.ambient);
  fast.diffuse = static_cast<float>(settings.light.diffuse);
  fast.kernels = FastKernels::own;
  if (splats.kernels.size() == 1) {
    // adj(W V W^T) by the adjugates of both: those of V alone are exact where the grid's axes are its own.
    const glm::dmat3 w(view.object_to_camera);
    const glm::dmat3 cofactors(glm::cross(w[1], w[2]), glm::cross(w[2], w[0]), glm::cross(w[0], w[1]));
    fast.variance = fast_variance(camera_variance(view, splats.kernels[0]),
                                  cofactors * adjugate(splats.kernels[0]) * glm::transpose(cofactors));
    const bool spherical = is_spherical(splats.kernels[0]) && !flat && fast.perspective;
    fast.kernels = spherical ? FastKernels::spherical : FastKernels::shared;
  }
  return fast;
}

struct Band : SheetBand {
  const FastTable* table = nullptr;
  void add(std::span<const SheetSplat> splats, std::span<const std::uint32_t> order) {
    add_to_sheet(splats, order, *table, *this);
  }
  void composite() { composite_sheet(*this); }
};

std::vector<Band> empty_bands(const View& view, const FastTable& table) {
  std::vector<Band> bands;
  for (int top = 0; top < view.height; top += RowBands::kRows) {
    Band& band = bands.emplace_back();
    band.table = &table;
    band.rows = {top, std::min(view.height, top + RowBands::kRows)};
    band.stride = static_cast<std::size_t>(view.width) + FastSurfels::kPadding;
    band.dirty = {view.width, band.rows.bottom, 0, band.rows.top};
    for (std::size_t c = 0; c < 4; ++c) {
      band.sheet[c].resize(band.stride * RowBands::kRows);
      band.picture[c].resize(band.sheet[c].size());
    }
  }
  return bands;
}

void copy(const SheetBand& band, FastVolumePicture& picture) {
  for (int row = band.rows.top; row < band.rows.bottom; ++row) {
    const std::size_t from = static_cast<std::size_t>(row - band.rows.top) * band.stride;
    const std::size_t to = static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width);
    for (std::size_t i = 0; i < static_cast<std::size_t>(picture.width); ++i) {
      picture.pixels[to + i] = {band.picture[0][from + i], band.picture[1][from + i],
                                band.picture[2][from + i], band.picture[3][from + i]};
    }
  }
}

}  // namespace

SpecularTable::SpecularTable(double specular, double shininess) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double cosine = std::min(1.0, static_cast<double>(i) / kSteps);
    values[i] = static_cast<float>(specular * std::pow(cosine, shininess));
  }
}

FastVolume::FastVolume(VolumeSplats splats) : splats_(std::move(splats)) {
  flat_ = std::ranges::any_of(splats_.splats, [](const VolumeSplat& splat) { return splat.flatness > 0; });
  if (splats_.kernels.size() == 1) return;
  kernels_.reserve(splats_.kernels.size());
  for (const glm::dmat3& kernel : splats_.kernels)
    kernels_.push_back(fast_variance(kernel, adjugate(kernel)));
}

FastVolumePicture FastVolume::draw(const View& view, const VolumeSettings& settings,
                                   const std::function<void(double)>& progress) {
  const FastVolumeView fast = fast_view(view, settings, splats_, flat_);
  const FastTable table(0.5 * settings.cutoff);
  const SpecularTable specular(settings.light.specular, settings.light.shininess);
  const SheetAxis axis = sheet_axis(view, splats_, settings.axis);
  SheetOrder& order = orders_[static_cast<std::size_t>(axis.axis)];
  if (order.first.empty()) order = sheet_order(splats_, axis.axis);
  FastVolumePicture picture{view.width, view.height, {}, splats_.splats.size(), 0};
  picture.pixels.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  std::vector<Band> bands = empty_bands(view, table);
  const SheetsDrawn drawn = draw_sheets<SheetSplat>(
      view, order, axis.last_is_nearest, bands, progress,
      [&](std::span<const std::uint32_t> numbers, std::span<const std::uint32_t> sheets, SheetSplat* out,
          RowRange* rows) {
        return project_splats(fast, specular, splats_.splats, kernels_, numbers, sheets, out, rows);
      });
  picture.left_out -= drawn.splats;
  picture.sheets = drawn.sheets;
  for (const Band& band : bands) copy(band, picture);
  return picture;
}

}  // namespace splatscope::kernels
