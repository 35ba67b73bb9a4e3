#pragma once

#include <algorithm>
#include <glm/vec3.hpp>
#include <limits>
#include <span>

#include "traces/scene.h"

namespace splatscope::traces {

// Which keys of [camera] a scene gives; the others are chosen by frame_camera and place_planes.
struct CameraKeys {
  bool eye = false, target = false, up = false, fov_y_degrees = false, near = false, far = false;
};

// Turns a camera to all the surfels: a three-quarter view from above their front (+z, +y up) that they fill
// to the edge of the frame less a small margin. A key that is given stays. Positions must be finite; without
// surfels the camera stays as it is.
void frame_camera(std::span<const Surfel> surfels, const FrameSize& frame, const CameraKeys& given,
                  Camera& camera);

// The camera's axis, of unit length; zero where the target is the eye, which is refused later.
glm::dvec3 ahead_of(const Camera& camera);

// Along the camera's axis, from the eye: negative behind it.
struct DepthRange {
  double nearest = std::numeric_limits<double>::infinity();
  double furthest = -std::numeric_limits<double>::infinity();
  void add(double depth, double reach) {
    nearest = std::min(nearest, depth - reach);
    furthest = std::max(furthest, depth + reach);
  }
};

// Of the quads of both passes of at least one surfel: each reaches 2 radii at the least, and low-pass filters
// count as if they were seen at kEdgeOnCosine at most. A tenth of the range is room on either side; behind it
// z_t, but no more than the range: moved further, a quad hides nothing. Normals are of unit length.
DepthRange depths_of(std::span<const Surfel> surfels, const Splatting& splatting, const FrameSize& frame,
                     const Camera& camera);

// Clip planes as close to what is seen as they may be, for the sake of the depth's precision: the near one
// at a thousandth of the far one's distance at the least. A key that is given stays.
void place_planes(const DepthRange& depths, const CameraKeys& given, Camera& camera);

// The same of a scene with surfels; without keys both of them anew, where its frame or its eye has changed.
void place_planes(Scene& scene, const CameraKeys& given = {});

}  // namespace splatscope::traces
