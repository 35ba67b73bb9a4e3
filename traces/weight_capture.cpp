#include "traces/weight_capture.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <mutex>
#include <numbers>

#include "kernels/bounds.h"
#include "kernels/sphere_points.h"
#include "model/render.h"
#include "model/stop.h"
#include "traces/edges.h"
#include "traces/median.h"
#include "traces/splat_reach.h"

namespace splatscope::traces {
namespace {

constexpr double kSmallestCosine = 0.5;  // 60 degrees
// The least sum at a vertex, in sums at its surfel's centre: at a straight edge half of the splats are
// missing. Beyond the edge it falls to 0, and the inverse of that would brighten the little that is seen
// there.
constexpr float kLeastCorner = 0.5f;
constexpr double kCaptureFieldOfView = 45;  // degrees

// Looks at the whole sphere from one side.
struct CaptureView {
  glm::dvec3 eye;
  kernels::View view;
};

CaptureView looking_from(const kernels::Sphere& sphere, const glm::dvec3& from, int frame_size) {
  Camera camera;
  camera.fov_y_degrees = kCaptureFieldOfView;
  const double distance = sphere.radius / std::sin(0.5 * kCaptureFieldOfView * std::numbers::pi / 180);
  camera.eye = sphere.center + distance * from;
  camera.target = sphere.center;
  camera.up = std::abs(from.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  camera.near = 0.9 * (distance - sphere.radius);
  camera.far = distance + sphere.radius;
  return {camera.eye, view_of(camera, {frame_size, frame_size})};
}

// What the views show, and what they say about a point of the surface.
class CapturedViews {
 public:
  CapturedViews(std::span<const Surfel> surfels, const Splatting& splatting, const Capture& capture,
                const NumberFormats& formats, const std::function<void(double)>& progress)
      : both_faces_(splatting.faces != Faces::front) {
    const kernels::Sphere sphere = kernels::bounding_sphere(
        surfels, [&](const Surfel& surfel) { return corner_reach(splatting) * surfel.radius; });
    RenderOptions options;
    options.formats = formats;
    for (int i = 0; i < capture.views; ++i) {
      const glm::dvec3 direction = kernels::sphere_point(i, capture.views).place;
      const CaptureView view = looking_from(sphere, direction, capture.frame_size);
      if (may_be_asked(view, surfels, splatting)) views_.push_back(view);
    }
    if (views_.empty()) return;
    frames_.resize(views_.size(), splatscope::Frame(0, 0, formats));
    const std::vector<VertexWeights> unnormalized(surfels.size(), equal_weights(splatting.gamma));
    const Trace trace = splat_trace({surfels, unnormalized}, views_.front().view, splatting,
                                    {.prefilter = false, .sum_weights = true});
    // Where there are as many views as threads, each is drawn by one: a draw on several costs more in all.
    const int threads_a_view =
        std::max(1, tbb::this_task_arena::max_concurrency() / static_cast<int>(views_.size()));
    std::mutex mutex;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t i) {
      tbb::task_arena(threads_a_view).execute([&] {
        frames_[i] = render_view(trace, seen_from(views_[i].view, splatting, trace), options);
      });
      const std::lock_guard lock(mutex);
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(views_.size()));
    });
  }

  // The median, over the views that see `point` of a surfel's plane well, of the summed weights there; 0
  // where none does. `scratch` is for its use.
  float sum_at(const glm::dvec3& point, const glm::dvec3& normal, std::vector<float>& scratch) const {
    scratch.clear();
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (facing(normal, glm::normalize(views_[i].eye - point)) < kSmallestCosine) continue;
      const float sum = seen_sum(views_[i].view, frames_[i], point);
      if (sum > 0) scratch.push_back(sum);
    }
    return median(std::span(scratch));
  }

 private:
  // How far along its normal a point of the surface sees something.
  double facing(const glm::dvec3& normal, const glm::dvec3& toward) const {
    const double along = glm::dot(normal, toward);
    return both_faces_ ? std::abs(along) : along;
  }

  // False: nothing sees it well, neither centres nor corners. These lie in the plane across the normal, so no
  // further along it. Half of the views of a plane are in vain.
  bool may_be_asked(const CaptureView& view, std::span<const Surfel> surfels,
                    const Splatting& splatting) const {
    constexpr double kLeast = 0.999 * kSmallestCosine;  // for rounding
    return std::ranges::any_of(surfels, [&](const Surfel& surfel) {
      const glm::dvec3 toward = view.eye - glm::dvec3(surfel.position);
      const double nearest = glm::length(toward) - corner_reach(splatting) * surfel.radius;
      return facing(surfel.normal, toward) >= kLeast * nearest;
    });
  }

  // Read back from the pixel that holds the point; 0 where something hides it.
  static float seen_sum(const kernels::View& view, const splatscope::Frame& frame, const glm::dvec3& point) {
    const glm::dvec3 camera = view.camera_space(point);
    const glm::dvec2 window = view.window(camera);
    // All of the sphere is in the frame; what is not is no number.
    if (!(window.x >= 0 && window.x < view.width && window.y >= 0 && window.y < view.height)) return 0;
    const std::size_t pixel =
        static_cast<std::size_t>(window.y) * frame.width + static_cast<std::size_t>(window.x);
    const double depth = view.depth_scale() * (1 - view.near_plane / camera.z);
    return depth <= frame.depth_value(pixel) ? frame.color(pixel)[3] : 0;
  }

  bool both_faces_;  // are drawn; else a view from behind shows what lies behind the point
  std::vector<CaptureView> views_;
  std::vector<splatscope::Frame> frames_;
};

// The weights at the vertices of a surfel at an edge, where `sum` is that at its centre. A vertex from which
// nothing of the model is seen, because it lies beyond the edge or something hides it, has the centre's.
VertexWeights corner_weights(const CapturedViews& views, const Surfel& surfel, float sum,
                             const Splatting& splatting, std::vector<float>& scratch) {
  VertexWeights weights = equal_weights(splatting.gamma / sum);
  const auto corners = quad_corners(surfel, splatting);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const float at_corner = views.sum_at(corners[i], surfel.normal, scratch);
    if (at_corner > 0) {
      weights[i] = static_cast<float>(splatting.gamma / std::max(at_corner, kLeastCorner * sum));
    }
  }
  return weights;
}

}  // namespace

CapturedWeights capture_weights(std::span<const Surfel> surfels, const Splatting& splatting,
                                const Capture& capture, const NumberFormats& formats,
                                const std::function<void(double)>& progress) {
  CapturedWeights out;
  out.weights.resize(surfels.size(), equal_weights(splatting.gamma));
  if (surfels.empty()) return out;

  const CapturedViews views(surfels, splatting, capture, formats, progress);
  const std::vector<char> edge =
      capture.corner_weights ? at_edge(surfels) : std::vector<char>(surfels.size());
  std::vector<float> sums(surfels.size());  // at the centres; 0: seen from no view, < 0: outside of the box
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, surfels.size()), [&](const auto& range) {
    std::vector<float> scratch;
    stop_if_asked();
    for (std::size_t k = range.begin(); k != range.end(); ++k) {
      const glm::dvec3 position(surfels[k].position);
      const bool inside = glm::all(glm::lessThanEqual(capture.box_min, position)) &&
                          glm::all(glm::lessThanEqual(position, capture.box_max));
      sums[k] = inside ? views.sum_at(position, surfels[k].normal, scratch) : -1;
      if (!(sums[k] > 0)) continue;
      out.weights[k] = edge[k] ? corner_weights(views, surfels[k], sums[k], splatting, scratch)
                               : equal_weights(splatting.gamma / sums[k]);
    }
  });

  std::vector<float> seen;
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    if (sums[k] > 0) seen.push_back(sums[k]);
    out.unseen += sums[k] == 0;
    out.outside_box += sums[k] < 0;
    out.at_edges += sums[k] > 0 && edge[k];
  }
  out.captured = seen.size();
  const VertexWeights fallback = equal_weights(seen.empty() ? 1 : splatting.gamma / median(std::span(seen)));
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    if (sums[k] == 0) out.weights[k] = fallback;
  }
  return out;
}

CapturedWeights capture_weights(const Scene& scene, const NumberFormats& formats,
                                const std::function<void(double)>& progress) {
  return capture_weights(scene.surfels, scene.splatting, scene.capture, formats, progress);
}

CapturedWeights uniform_weights(std::size_t surfels, double weight) {
  CapturedWeights out;
  out.weights.resize(surfels, equal_weights(weight));
  return out;
}

}  // namespace splatscope::traces
