#include "traces/models/model_surfels.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "model/stop.h"
#include "traces/models/sampler.h"
#include "traces/neighbours.h"

namespace splatscope::traces {
namespace {

struct Sphere {
  glm::dvec3 center{};
  double radius = 0;
};

Sphere bounding_sphere(const std::vector<MeshSample>& samples) {
  glm::dvec3 low(samples.front().position), high = low;
  for (const MeshSample& s : samples) {
    low = glm::min(low, glm::dvec3(s.position));
    high = glm::max(high, glm::dvec3(s.position));
  }
  Sphere sphere{0.5 * (low + high), 0};
  for (const MeshSample& s : samples)
    sphere.radius = std::max(sphere.radius, glm::distance(glm::dvec3(s.position), sphere.center));
  if (!(sphere.radius > 0)) sphere.radius = 1;  // a single point
  return sphere;
}

float light_on(const glm::vec3& normal, double shading) {
  const glm::dvec3 to_light = glm::normalize(glm::dvec3(-0.35, 0.8, 0.6));
  const double facing = 0.5 + 0.5 * glm::dot(glm::dvec3(normal), to_light);  // 0 to 1
  return static_cast<float>(1 - shading * (1 - facing));
}

}  // namespace

std::vector<Surfel> sample_model(const Model& model, const ModelOptions& options,
                                 const std::function<void(double)>& progress) {
  SamplerOptions sampler;
  sampler.count = options.count;
  const std::vector<MeshSample> samples = sample(model.mesh, sampler, progress);
  std::vector<Surfel> surfels(samples.size());
  if (surfels.empty()) return surfels;
  const Sphere sphere = bounding_sphere(samples);
  const double unit = sphere.radius * options.pattern_scale;
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
  estimate_radii(surfels, options.neighbours);
  return surfels;
}

}  // namespace splatscope::traces
