#include "kernels/reference/fast_splatting.h"

#include <algorithm>
#include <cmath>

namespace splatscope::kernels {

FastCamera::FastCamera(const View& view)
    : eta(static_cast<float>(view.eta)),
      center_x(static_cast<float>(view.center().x)),
      center_y(static_cast<float>(view.center().y)),
      near_plane(static_cast<float>(view.near_plane)),
      far_plane(static_cast<float>(view.far_plane)),
      width(static_cast<float>(view.width)),
      height(static_cast<float>(view.height)) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      rows[row][column] = static_cast<float>(view.object_to_camera[column][row]);
    }
  }
}

namespace {

FastView fast_view(const View& view, const FastSettings& settings) {
  FastView fast(view);
  fast.low_pass = settings.prefilter ? 1.0f : 0.0f;
  fast.reach = static_cast<float>(std::sqrt(2.0 * settings.cutoff));
  fast.cull_back_faces = settings.cull_back_faces;
  return fast;
}

// From the 1/z of the nearest quad to that of the furthest splat which still counts: the quad moved back by
// z_t along the pixel's ray, and the far plane.
void move_back(const FastView& view, float depth_offset, FastBand& band) {
  const float inverse_eta = 1.0f / view.eta, furthest = 1.0f / view.far_plane;
  const auto columns = static_cast<int>(view.width);
  float* row_start = band.nearest.data();
  for (int row = band.rows.top; row < band.rows.bottom; ++row, row_start += band.stride) {
    const float y = (static_cast<float>(row) + 0.5f - view.center_y) * inverse_eta;
    for (int column = 0; column < columns; ++column) {
      const float x = (static_cast<float>(column) + 0.5f - view.center_x) * inverse_eta;
      const float along_z = depth_offset / std::sqrt(x * x + y * y + 1.0f);
      const float w = row_start[column];
      row_start[column] = std::max(w / (1.0f + w * along_z), furthest);
    }
  }
}

void normalize(const FastBand& band, FastPicture& picture) {
  std::size_t from = 0;
  for (int row = band.rows.top; row < band.rows.bottom; ++row, from += band.stride) {
    glm::vec4* out = picture.pixels.data() + std::size_t(row) * std::size_t(picture.width);
    for (std::size_t column = 0; column < std::size_t(picture.width); ++column) {
      const float weight = band.sums[3][from + column];
      const float scale = weight > 0 ? 1.0f / weight : 0.0f;
      out[column] = {scale * band.sums[0][from + column], scale * band.sums[1][from + column],
                     scale * band.sums[2][from + column], weight};
    }
  }
}

}  // namespace

static_assert(RowBands::kChunk % FastSurfels::kPadding == 0);  // prepare_splats begins at whole registers

FastTable::FastTable(double cutoff)
    : limit(static_cast<float>(2 * cutoff)), scale(static_cast<float>(kSteps / (2 * cutoff))) {
  for (int i = 0; i <= kSteps; ++i) {
    const double q = i == kSteps ? 2 * cutoff : 2 * cutoff * (i + 0.5) / kSteps;
    values[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-0.5 * q));
  }
}

FastSplatting::FastSplatting(std::span<const Surfel> surfels)
    : surfels_(surfels.size()),
      splats_((surfels.size() + FastSurfels::kPadding - 1) / FastSurfels::kPadding * FastSurfels::kPadding) {
  for (auto& component : model_.values) component.resize(splats_.size());
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    const Surfel& surfel = surfels[k];
    const double values[FastSurfels::kComponents] = {
        surfel.position.x,  surfel.position.y,  surfel.position.z,  surfel.tangent_s.x, surfel.tangent_s.y,
        surfel.tangent_s.z, surfel.tangent_t.x, surfel.tangent_t.y, surfel.tangent_t.z, surfel.sigma,
        surfel.weight,      surfel.color.r,     surfel.color.g,     surfel.color.b};
    for (std::size_t c = 0; c < FastSurfels::kComponents; ++c) {
      model_.values[c][k] = static_cast<float>(values[c]);
    }
  }
}

FastPicture FastSplatting::draw(const View& view, const FastSettings& settings) {
  const FastView fast = fast_view(view, settings);
  const FastTable table(settings.cutoff);
  FastPicture picture{view.width, view.height, {}, surfels_};
  picture.pixels.resize(std::size_t(view.width) * std::size_t(view.height));
  const RowBands bands(view.height, surfels_, [&](std::size_t begin, std::size_t end, RowRange* rows) {
    return prepare_splats(model_, fast, begin, end, splats_.data() + begin, rows);
  });
  picture.left_out -= bands.kept();
  const float nearest_w = 1.0f / fast.near_plane;
  const std::size_t stride = std::size_t(view.width) + FastSurfels::kPadding;
  bands.for_each_band([&](int index) {
    FastBand band{bands.rows(index), stride, std::vector<float>(stride * RowBands::kRows), {}};
    for (auto& sum : band.sums) sum.resize(band.nearest.size());
    bands.for_each_run(
        index, [&](std::span<const std::uint32_t> order) { draw_quads(splats_, order, nearest_w, band); });
    move_back(fast, static_cast<float>(settings.depth_offset), band);
    bands.for_each_run(index, [&](std::span<const std::uint32_t> order) {
      add_splats(splats_, order, nearest_w, table, band);
    });
    normalize(band, picture);
  });
  return picture;
}

}  // namespace splatscope::kernels
