#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec4.hpp>
#include <vector>

#include "kernels/reference/volume/fast_sheet.h"
#include "kernels/reference/volume/volume_rendering.h"
#include "kernels/reference/volume/volume_splats.h"
#include "kernels/view.h"

namespace splatscope::kernels {

struct FastVolumePicture {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> pixels;  // r g b times opacity, and opacity; rows from the top
  std::size_t left_out = 0;       // splats not between the near and the far plane, outside of the
                                  // picture, or without a finite footprint
  std::size_t sheets = 0;         // that have a splat in the picture
};

// The picture of volume_picture in single precision: SIMD over splats while they are projected and over
// pixels while they are drawn; W V W^T once a frame on grids, J J^T alone where V is spherical; the radial
// index by two additions a pixel and its Gaussian from a table (section 7.1). The same bits for any number of
// threads and on every SIMD target. Keeps the orders of the sheets between frames: one draw at a time.
class FastVolume {
 public:
  explicit FastVolume(VolumeSplats splats);

  FastVolumePicture draw(const View& view, const VolumeSettings& settings,
                         const std::function<void(double)>& progress = {});

  const VolumeSplats& splats() const { return splats_; }

 private:
  VolumeSplats splats_;
  bool flat_ = false;                  // one of the splats is
  std::vector<FastVariance> kernels_;  // of FastKernels::own
  std::array<SheetOrder, kSheetAxes> orders_;
};

}  // namespace splatscope::kernels
