#include "traces/surfels.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "traces/neighbours.h"
#include "traces/plane.h"
#include "traces/point_file.h"

namespace splatscope::traces {
namespace {

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_finite(const Surfel& s) {
  return is_finite(s.position) && is_finite(s.normal) && std::isfinite(s.radius) && is_finite(s.color);
}

// In double: the square of a small float's length would be 0.
bool normalize(Surfel& s) {
  const double length = glm::length(glm::dvec3(s.normal));
  if (length > 0) s.normal = glm::vec3(glm::dvec3(s.normal) / length);
  return length > 0;
}

Surfels complete(PointFile points, const SceneSettings& settings) {
  Surfels result;
  std::vector<Surfel>& surfels = points.surfels;
  result.skipped.not_finite = std::erase_if(surfels, [](const Surfel& s) { return !is_finite(s); });
  if (!points.has_radii) estimate_radii(surfels, settings.surfels.neighbours);
  result.skipped.zero_radius = std::erase_if(surfels, [](const Surfel& s) { return !(s.radius > 0); });
  if (!points.has_normals) estimate_normals(surfels, settings.surfels.neighbours, settings.camera.eye);
  result.skipped.zero_normal = std::erase_if(surfels, [](Surfel& s) { return !normalize(s); });
  for (Surfel& s : surfels) s.color = glm::clamp(s.color, 0.0f, 1.0f);
  result.average_spacing = average_spacing(surfels);
  // A single surfel has no neighbour; any offset will do for it.
  if (!(result.average_spacing > 0)) result.average_spacing = surfels.empty() ? 1 : surfels.front().radius;
  result.surfels = std::move(surfels);
  return result;
}

}  // namespace

Surfels make_surfels(const SceneSettings& settings, const std::filesystem::path& folder) {
  if (settings.surfels.file.empty()) return {make_plane(settings.surfels), {}, kPlaneSpacing};
  return complete(read_ply(folder / settings.surfels.file), settings);
}

}  // namespace splatscope::traces
