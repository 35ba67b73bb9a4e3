#include "traces/volumes/sample_file.h"

#include <fmt/format.h>

#include <cmath>

#include "model/error.h"
#include "traces/point_file.h"

namespace splatscope::traces {

std::vector<kernels::VolumeSample> read_samples(const std::filesystem::path& path, double kernel_variance) {
  const PointFile points = read_ply(path);
  const std::string file = path.string();
  if (points.surfels.empty()) throw UserError(file, 0, "no vertices, expected the samples of a volume");
  if (points.values.empty() || !points.has_radii) {
    throw UserError(
        file, 0,
        fmt::format("property {} of element vertex is missing, expected x, y, z, value and radius",
                    points.values.empty() ? "value" : "radius"));
  }
  std::vector<kernels::VolumeSample> samples;
  samples.reserve(points.surfels.size());
  for (std::size_t i = 0; i < points.surfels.size(); ++i) {
    const Surfel& point = points.surfels[i];
    const double radius = static_cast<double>(point.radius);
    double sum = double{point.radius} + points.values[i];
    for (int axis = 0; axis < 3; ++axis) sum += double{point.position[axis]} + point.normal[axis];
    if (!std::isfinite(sum))
      throw UserError(file, 0, fmt::format("vertex {} has a NaN or infinity, expected finite numbers", i));
    if (!(point.radius >= 1e-9f && point.radius <= 1e9f))
      throw UserError(file, 0, fmt::format("vertex {} has radius {}, expected 1e-9 to 1e9", i, point.radius));
    samples.push_back({.position = point.position,
                       .variance = glm::dmat3(kernel_variance * radius * radius),
                       .cell = radius * radius * radius,
                       .gradient = point.normal,
                       .value = points.values[i]});
  }
  return samples;
}

}  // namespace splatscope::traces
