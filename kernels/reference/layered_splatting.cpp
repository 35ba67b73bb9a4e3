#include "kernels/reference/layered_splatting.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <optional>

#include "kernels/reference/ray_plane.h"
#include "kernels/reference/row_bands.h"

namespace splatscope::kernels {
namespace {

// A surfel as one view sees it.
struct Splat {
  PixelBox box;
  glm::dvec2 center{};               // x_k, pixels
  glm::dmat2 conic{0.0};             // Q of section 7.1
  RayFunction inverse_z;             // of the tangent plane
  double nearest = 0, furthest = 0;  // camera z of the surfel's quad
  double height = 0;                 // s_k rho_k(x_k)
  glm::dvec4 color_opacity{};
};

// A contribution on its way to a pixel.
struct Contribution {
  double z;
  double weight;
};

struct Layer {
  double z = 0;
  double weight = 0;
  glm::dvec4 color_opacity{0.0};  // times the weights

  void add(const Contribution& contribution, const glm::dvec4& value) {
    weight += contribution.weight;
    color_opacity += contribution.weight * value;
  }
};

// The layers of a band of rows, of each pixel from the nearest to the furthest.
class LayerBand {
 public:
  LayerBand(std::size_t pixels, const LayeredSettings& settings)
      : settings_(settings),
        most_(static_cast<std::size_t>(settings.layers)),
        layers_(pixels * most_),
        counts_(pixels, 0) {}

  void put(std::size_t pixel, const Contribution& contribution, const glm::dvec4& value) {
    const std::span<Layer> all = std::span(layers_).subspan(pixel * most_, most_);
    std::size_t& count = counts_[pixel];
    std::size_t place = 0;  // of a layer of its own
    Layer* nearest = nullptr;
    double least = settings_.same_surface;
    for (Layer& layer : all.first(count)) {
      const double distance = std::abs(layer.z - contribution.z);
      if (distance < least) {
        least = distance;
        nearest = &layer;
      }
      place += layer.z <= contribution.z;
    }
    if (nearest) {
      nearest->add(contribution, value);
      ++outcomes_.added;
    } else if (place == most_) {
      ++outcomes_.dropped;
    } else {
      const bool full = count == most_;
      ++(full ? outcomes_.replaced : outcomes_.founded);
      count += !full;
      std::move_backward(all.begin() + static_cast<std::ptrdiff_t>(place),
                         all.begin() + static_cast<std::ptrdiff_t>(count - 1),
                         all.begin() + static_cast<std::ptrdiff_t>(count));
      all[place] = {.z = contribution.z};
      all[place].add(contribution, value);
    }
  }

  // Front to back, with the background behind. A surface that bends away from the eye within a pixel leaves
  // its weight in several layers, which cover different parts of it: layers are joined as long as all they
  // hold is not more than one surface's.
  glm::dvec4 blended(std::size_t pixel) const {
    glm::dvec4 result(0.0);
    Layer joined;
    for (const Layer& layer : std::span(layers_).subspan(pixel * most_, counts_[pixel])) {
      if (joined.weight + layer.weight > kOneSurface * settings_.whole_weight) {
        blend(joined, result);
        joined = {};
      }
      joined.weight += layer.weight;
      joined.color_opacity += layer.color_opacity;
    }
    blend(joined, result);
    return {glm::dvec3(result) + (1 - result.w) * settings_.background, result.w};
  }

  double nearest_weight(std::size_t pixel) const {
    return counts_[pixel] == 0 ? 0 : layers_[pixel * most_].weight;
  }
  const LayerOutcomes& outcomes() const { return outcomes_; }

 private:
  static constexpr double kOneSurface = 1.25;  // whole weights: sums of filters are uneven

  void blend(const Layer& layer, glm::dvec4& result) const {
    if (!(layer.weight > 0)) return;
    const glm::dvec4 mean = layer.color_opacity / layer.weight;
    const double coverage =
        settings_.whole_weight > 0 ? std::min(1.0, layer.weight / settings_.whole_weight) : 1.0;
    const double opacity = (1 - result.w) * coverage * mean.w;
    result += glm::dvec4(opacity * glm::dvec3(mean), opacity);
  }

  const LayeredSettings& settings_;
  std::size_t most_;
  std::vector<Layer> layers_;
  std::vector<std::size_t> counts_;
  LayerOutcomes outcomes_;
};

std::optional<Splat> prepare(const View& view, const Surfel& surfel, double opacity,
                             const LayeredSettings& settings) {
  const glm::dvec3 o = view.camera_space(surfel.position);
  const glm::dvec3 normal =
      glm::cross(view.camera_direction(surfel.tangent_s), view.camera_direction(surfel.tangent_t));
  if (settings.cull_back_faces && glm::dot(normal, o) > 0) return std::nullopt;
  const std::optional<SurfelFilter> filter = surfel_filter(view, surfel, settings.prefilter);
  if (!filter) return std::nullopt;
  Splat splat;
  const glm::dmat2 to_screen = filter->jacobian * filter->axes;
  const glm::dmat2 to_filter = glm::inverse(to_screen);
  splat.center = view.window(o);
  splat.conic = glm::transpose(to_filter) * to_filter;
  const double reach = std::sqrt(2 * settings.cutoff);
  const glm::dmat2 variance = to_screen * glm::transpose(to_screen);
  splat.box =
      box_about(view, splat.center, reach * glm::dvec2(std::sqrt(variance[0][0]), std::sqrt(variance[1][1])));
  splat.inverse_z = RayFunction(view, normal / glm::dot(normal, o));
  const double depth = std::abs(view.camera_direction(surfel.tangent_s).z) +
                       std::abs(view.camera_direction(surfel.tangent_t).z);
  splat.nearest = o.z - depth;
  splat.furthest = o.z + depth;
  splat.height = surfel.weight * 0.5 * std::numbers::inv_pi / std::sqrt(filter->determinant);
  splat.color_opacity = {surfel.color, opacity};
  return splat;
}

// `put(column, contribution)` for each pixel of a row that the splat reaches.
template <class Put>
void for_row(const View& view, const LayeredSettings& settings, const Splat& splat, int row, const Put& put) {
  const glm::dmat2& q = splat.conic;
  const double dx = splat.box.left + 0.5 - splat.center.x, dy = row + 0.5 - splat.center.y;
  double index = q[0][0] * dx * dx + 2 * q[1][0] * dx * dy + q[1][1] * dy * dy;
  double growth = q[0][0] * (2 * dx + 1) + 2 * q[1][0] * dy;
  double inverse_z = splat.inverse_z(splat.box.left + 0.5, row + 0.5);
  for (int column = splat.box.left; column < splat.box.right; ++column) {
    const double z = 1 / inverse_z;
    if (index <= 2 * settings.cutoff && z >= view.near_plane && z <= view.far_plane)
      put(column, {std::clamp(z, splat.nearest, splat.furthest), splat.height * std::exp(-0.5 * index)});
    index += growth;
    growth += 2 * q[0][0];
    inverse_z += splat.inverse_z.by_x;
  }
}

}  // namespace

LayeredPicture layered_splatting(const View& view, std::span<const Surfel> surfels,
                                 std::span<const double> opacities, const LayeredSettings& settings) {
  const auto width = static_cast<std::size_t>(view.width);
  LayeredPicture picture{view.width, view.height, {}, {}, {}};
  picture.pixels.resize(width * static_cast<std::size_t>(view.height));
  picture.weights.resize(picture.pixels.size());
  std::vector<Splat> splats(surfels.size());
  const RowBands bands(view.height, surfels.size(), [&](std::size_t begin, std::size_t end, RowRange* rows) {
    std::size_t kept = begin;
    for (std::size_t k = begin; k < end; ++k) {
      if (auto splat = prepare(view, surfels[k], opacities.empty() ? 1 : opacities[k], settings)) {
        rows[kept - begin] = {splat->box.top, splat->box.bottom};
        splats[kept++] = *splat;
      }
    }
    return kept - begin;
  });
  std::vector<LayerOutcomes> outcomes(static_cast<std::size_t>(bands.count()));
  bands.for_each_band([&](int index) {
    const RowRange rows = bands.rows(index);
    LayerBand band(static_cast<std::size_t>(rows.bottom - rows.top) * width, settings);
    bands.for_each_run(index, [&](std::span<const std::uint32_t> run) {
      for (const std::uint32_t k : run) {
        const Splat& splat = splats[k];
        const int bottom = std::min(splat.box.bottom, rows.bottom);
        for (int row = std::max(splat.box.top, rows.top); row < bottom; ++row) {
          const std::size_t first = static_cast<std::size_t>(row - rows.top) * width;
          for_row(view, settings, splat, row, [&](int column, const Contribution& contribution) {
            band.put(first + static_cast<std::size_t>(column), contribution, splat.color_opacity);
          });
        }
      }
    });
    const std::size_t first = static_cast<std::size_t>(rows.top) * width;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows.bottom - rows.top) * width; ++i) {
      picture.pixels[first + i] = band.blended(i);
      picture.weights[first + i] = band.nearest_weight(i);
    }
    outcomes[static_cast<std::size_t>(index)] = band.outcomes();
  });
  for (const LayerOutcomes& band : outcomes) {
    picture.outcomes.added += band.added;
    picture.outcomes.founded += band.founded;
    picture.outcomes.replaced += band.replaced;
    picture.outcomes.dropped += band.dropped;
  }
  return picture;
}

}  // namespace splatscope::kernels
