#pragma once

#include <span>

#include "traces/scene.h"

namespace splatscope::traces {

// Which keys of [camera] a scene gives; the others are chosen by frame_camera.
struct CameraKeys {
  bool eye = false, target = false, up = false, fov_y_degrees = false, near = false, far = false;
};

// How far the corners of a splat's quads, of either pass, are from its centre before the low-pass filter, in
// radii of its surfel.
double corner_reach(const Splatting& splatting);

// Completes a camera so that it sees all the surfels: a three-quarter view from above their front (+z, +y up)
// that they fill to the edge of the frame less a small margin, with the clip planes as close to their splats
// (`reach` radii, 2 at the least) as they may be, for the sake of the depth's precision. A key that is given
// stays. Positions must be finite; without surfels the camera stays as it is.
void frame_camera(std::span<const Surfel> surfels, double reach, const FrameSize& frame,
                  const CameraKeys& given, Camera& camera);

}  // namespace splatscope::traces
