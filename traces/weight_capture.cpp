#include "traces/weight_capture.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "model/render.h"
#include "traces/splat_trace.h"

namespace splatscope::traces {
namespace {

constexpr int kViews = 16;
constexpr int kFrameSize = 512;             // pixels, as the paper's frames
constexpr double kSmallestCosine = 0.5;     // 60 degrees
constexpr double kCaptureFieldOfView = 45;  // degrees

struct Sphere {
  glm::dvec3 center{};
  double radius = 0;
};

// About the middle of the bounding box, all quads inside.
Sphere bounding_sphere(const std::vector<Surfel>& surfels) {
  glm::dvec3 low(surfels.front().position), high = low;
  for (const Surfel& surfel : surfels) {
    low = glm::min(low, glm::dvec3(surfel.position));
    high = glm::max(high, glm::dvec3(surfel.position));
  }
  Sphere sphere{0.5 * (low + high), 0};
  for (const Surfel& surfel : surfels) {
    const double reach = glm::length(glm::dvec3(surfel.position) - sphere.center) + 2.0 * surfel.radius;
    sphere.radius = std::max(sphere.radius, reach);
  }
  return sphere;
}

// Spherical Fibonacci points: `count` directions spread evenly.
glm::dvec3 direction(int index, int count) {
  const double z = 1 - (2 * index + 1.0) / count;
  const double angle = 2 * std::numbers::pi * index / std::numbers::phi;
  const double ring = std::sqrt(1 - z * z);
  return {ring * std::cos(angle), ring * std::sin(angle), z};
}

Scene looking_from(const Scene& scene, const Sphere& sphere, const glm::dvec3& from) {
  Scene view;
  view.camera.fov_y_degrees = kCaptureFieldOfView;
  const double distance = sphere.radius / std::sin(0.5 * kCaptureFieldOfView * std::numbers::pi / 180);
  view.camera.eye = sphere.center + distance * from;
  view.camera.target = sphere.center;
  view.camera.up = std::abs(from.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  view.camera.near = 0.9 * (distance - sphere.radius);
  view.camera.far = distance + sphere.radius;
  view.frame.width = view.frame.height = kFrameSize;
  view.splatting = scene.splatting;
  return view;
}

double median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// Appends the summed weight at every surfel whose centre this view sees well.
void sample_view(const std::vector<Surfel>& surfels, const kernels::View& view, const glm::dvec3& eye,
                 const splatscope::Frame& frame, std::vector<std::vector<float>>& samples) {
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    const glm::dvec3 position(surfels[k].position);
    const double cosine = glm::dot(glm::dvec3(surfels[k].normal), glm::normalize(eye - position));
    if (std::abs(cosine) < kSmallestCosine) continue;
    // The view holds the whole bounding sphere: every centre is in front of the near plane and in the frame.
    const glm::dvec3 camera = view.camera_space(position);
    const glm::dvec2 window = view.window(camera);
    const std::size_t pixel =
        static_cast<std::size_t>(window.y) * frame.width + static_cast<std::size_t>(window.x);
    const double depth =
        view.far_plane / (view.far_plane - view.near_plane) * (1 - view.near_plane / camera.z);
    const float sum = frame.color(pixel)[3];
    if (depth <= frame.depth_value(pixel) && sum > 0) samples[k].push_back(sum);
  }
}

}  // namespace

CapturedWeights capture_weights(const Scene& scene, const NumberFormats& formats,
                                const std::function<void(double)>& progress) {
  const std::vector<Surfel>& surfels = scene.surfels;
  CapturedWeights out;
  out.weights.resize(surfels.size(), 1.0f);
  if (surfels.empty()) return out;

  const auto gamma = static_cast<float>(scene.splatting.gamma);
  const std::vector<float> unnormalized(surfels.size(), gamma);
  const Sphere sphere = bounding_sphere(surfels);
  RenderOptions options;
  options.formats = formats;
  options.record_work = false;
  std::vector<std::vector<float>> samples(surfels.size());
  for (int i = 0; i < kViews; ++i) {
    if (progress) progress(static_cast<double>(i) / kViews);
    const Scene from = looking_from(scene, sphere, direction(i, kViews));
    const kernels::View view = view_of(from.camera, from.frame);
    const Trace trace = splat_trace(surfels, view, from.splatting,
                                    {.weights = unnormalized, .prefilter = false, .sum_weights = true});
    sample_view(surfels, view, from.camera.eye, render(trace, options).frame, samples);
  }

  std::vector<float> sums;  // of the surfels that were seen
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    if (samples[k].empty()) continue;
    ++out.captured;
    sums.push_back(static_cast<float>(median(samples[k])));
    out.weights[k] = gamma / sums.back();
  }
  const float fallback = sums.empty() ? 1.0f : gamma / static_cast<float>(median(sums));
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    if (samples[k].empty()) out.weights[k] = fallback;
  }
  return out;
}

}  // namespace splatscope::traces
