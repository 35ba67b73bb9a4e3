#include "traces/surfels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "model/error.h"
#include "traces/models/mesh_file.h"
#include "traces/models/model_surfels.h"
#include "traces/models/procedural.h"
#include "traces/neighbours.h"
#include "traces/plane.h"
#include "traces/point_file.h"
#include "traces/scene.h"

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

// The later ones of those at the same position with a normal of the same direction: their splats would count
// twice.
std::size_t erase_duplicates(std::vector<Surfel>& surfels) {
  const auto place = [&](std::uint32_t i) {
    return std::tie(surfels[i].position.x, surfels[i].position.y, surfels[i].position.z);
  };
  const auto direction = [&](std::uint32_t i) {
    Surfel s = surfels[i];
    normalize(s);
    return std::tuple(s.normal.x, s.normal.y, s.normal.z);
  };
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    return place(a) == place(b) && direction(a) == direction(b);
  };
  std::vector<std::uint32_t> order(surfels.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    if (place(a) != place(b)) return place(a) < place(b);
    const auto da = direction(a), db = direction(b);
    return da != db ? da < db : a < b;
  });
  std::vector<char> repeated(surfels.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) repeated[order[i]] = same(order[i], order[i - 1]);
  std::size_t i = 0;
  return std::erase_if(surfels, [&](const Surfel&) { return repeated[i++] != 0; });
}

Surfels complete(PointFile points, const SceneSettings& settings) {
  Surfels result;
  result.camera = settings.camera;
  std::vector<Surfel>& surfels = points.surfels;
  result.skipped.not_finite = std::erase_if(surfels, [](const Surfel& s) { return !is_finite(s); });
  if (settings.surfels.mirror) {
    for (Surfel& s : surfels) {
      s.position.x = -s.position.x;
      s.normal.x = -s.normal.x;
    }
  }
  const auto leave_out_zero_radii = [&] {
    result.skipped.zero_radius += std::erase_if(surfels, [](const Surfel& s) { return !(s.radius > 0); });
  };
  const auto leave_out_zero_normals = [&] {
    result.skipped.zero_normal = std::erase_if(surfels, [](Surfel& s) { return !normalize(s); });
  };
  // Before they are neighbours of others, or frame the camera.
  if (points.has_radii) leave_out_zero_radii();
  if (points.has_normals) leave_out_zero_normals();
  result.skipped.duplicate = erase_duplicates(surfels);
  if (!points.has_radii) {
    estimate_radii(surfels, settings.surfels.neighbours);
    leave_out_zero_radii();
  }
  frame_camera(surfels, {settings.width, settings.height}, settings.camera_given, result.camera);
  if (!points.has_normals) {
    estimate_normals(surfels, settings.surfels.neighbours, result.camera.eye);
    leave_out_zero_normals();
  }
  for (Surfel& s : surfels) s.color = glm::clamp(s.color, 0.0f, 1.0f);
  result.average_spacing = average_spacing(surfels);
  // A single surfel has no neighbour; any offset will do for it.
  if (!(result.average_spacing > 0)) result.average_spacing = surfels.empty() ? 1 : surfels.front().radius;
  if (!points.has_normals) result.estimated.normals = surfels.size();
  if (!points.has_radii) result.estimated.radii = surfels.size();
  result.surfels = std::move(surfels);
  return result;
}

}  // namespace

SampledModel sample_source(const SurfelSource& source, const std::filesystem::path& folder,
                           const std::function<void(double)>& progress,
                           const std::function<void(const std::vector<NamedFile>&)>& files_read) {
  Model model;
  MeshCounts counts;
  if (source.file.empty()) {
    model = make_procedural(source.generator);
    counts.triangles = model.mesh.triangles.size();
  } else {
    MeshFile file = read_mesh(folder / source.file);
    std::vector<NamedFile> files;
    for (std::filesystem::path& part : file.files) files.push_back({"the mesh", std::move(part)});
    if (files_read) files_read(files);
    counts = mend(file.model.mesh);
    counts.triangles_out_of_range += file.faces_out_of_range;
    counts.textures_unreadable = file.textures_unreadable;
    counts.materials_unreadable = file.materials_unreadable;
    model = std::move(file.model);
    if (model.mesh.triangles.empty())
      throw UserError(
          (folder / source.file).string(), 0,
          fmt::format("no triangle of it has a surface: {}, expected a mesh", describe_left_out(counts)));
  }
  ModelOptions options;
  options.count = source.count > 0      ? static_cast<std::size_t>(source.count)
                  : source.file.empty() ? default_count(source.generator)
                                        : kMeshSurfels;
  options.pattern = source.pattern;
  options.pattern_scale = source.pattern_scale;
  options.shading = source.shading;
  options.neighbours = source.neighbours;
  ModelSurfels made = sample_model(model, options, progress);
  SampledModel result{std::move(made.surfels), counts, made.copies, 0};
  const auto cannot_be_drawn = [](const Surfel& s) { return !(s.radius > 0); };
  result.zero_radius = static_cast<std::size_t>(std::ranges::count_if(result.surfels, cannot_be_drawn));
  return result;
}

std::string describe(const SampledModel& sampled) {
  std::string text = fmt::format("{} surfels {}", sampled.surfels.size(), describe(sampled.mesh));
  if (sampled.copies > 0) text += fmt::format(", {} at the place of another", sampled.copies);
  if (sampled.zero_radius > 0) text += fmt::format(", {} of radius 0", sampled.zero_radius);
  return text;
}

Surfels make_surfels(const SceneSettings& settings, const std::filesystem::path& folder,
                     const std::function<void(double)>& progress) {
  const SurfelSource& source = settings.surfels;
  if (is_plane(source)) return {make_plane(source), {}, {}, {}, settings.camera, kPlaneSpacing};
  if (!source.file.empty() && !is_mesh_file(folder / source.file)) {
    PointFile points = read_ply(folder / source.file);
    if (points.surfels.empty())
      throw UserError((folder / source.file).string(), 0, "no vertices, expected the surfels of a scene");
    return complete(std::move(points), settings);
  }
  std::vector<NamedFile> files;
  SampledModel sampled =
      sample_source(source, folder, progress, [&](const std::vector<NamedFile>& read) { files = read; });
  Surfels result = complete({std::move(sampled.surfels), true, true, {}}, settings);
  result.mesh = sampled.mesh;
  result.files = std::move(files);
  return result;
}

}  // namespace splatscope::traces
