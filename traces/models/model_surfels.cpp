#include "traces/models/model_surfels.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "kernels/bounds.h"
#include "model/stop.h"
#include "traces/models/sampler.h"
#include "traces/neighbours.h"

namespace splatscope::traces {
namespace {

float light_on(const glm::vec3& normal, double shading) {
  const glm::dvec3 to_light = glm::normalize(glm::dvec3(-0.35, 0.8, 0.6));
  const double facing = 0.5 + 0.5 * glm::dot(glm::dvec3(normal), to_light);  // 0 to 1
  return static_cast<float>(1 - shading * (1 - facing));
}

double area_of(const Mesh& mesh) {
  double twice = 0;
  for (const auto& [a, b, c] : corners_of(mesh))
    twice += glm::length(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)));
  return 0.5 * twice;
}

// Copies have the radius of what they are copies of: counted as neighbours they would make it smaller.
void set_radii(const Mesh& mesh, const MeshSamples& samples, int neighbours, std::span<Surfel> surfels) {
  const std::size_t distinct = samples.distinct();
  if (distinct == 1)
    surfels[0].radius = static_cast<float>(std::sqrt(area_of(mesh) / std::numbers::pi));
  else
    estimate_radii(surfels.first(distinct), neighbours);
  for (std::size_t i = distinct; i < surfels.size(); ++i)
    surfels[i].radius = surfels[samples.copy_of[i - distinct]].radius;
}

}  // namespace

ModelSurfels sample_model(const Model& model, const ModelOptions& options,
                          const std::function<void(double)>& progress) {
  SamplerOptions sampler;
  sampler.count = options.count;
  const MeshSamples sampled = sample(model.mesh, sampler, progress);
  const std::vector<MeshSample>& samples = sampled.points;
  std::vector<Surfel> surfels(samples.size());
  if (surfels.empty()) return {};
  const kernels::Sphere sphere = kernels::bounding_sphere(samples, [](const MeshSample&) { return 0.0; });
  // A single point has no radius.
  const double unit = (sphere.radius > 0 ? sphere.radius : 1) * options.pattern_scale;
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    stop_if_asked();
    const SurfacePoint point = surface_point(model.mesh, samples[i].triangle, samples[i].weights);
    const glm::vec3 color =
        options.pattern == Pattern::own
            ? model.paint(point)
            : pattern_color(options.pattern, (glm::dvec3(point.position) - sphere.center) / unit);
    surfels[i].position = point.position;
    surfels[i].normal = point.normal;
    surfels[i].color = light_on(point.normal, options.shading) * glm::clamp(color, 0.0f, 1.0f);
  });
  set_radii(model.mesh, sampled, options.neighbours, surfels);
  return {std::move(surfels), sampled.copy_of.size()};
}

}  // namespace splatscope::traces
