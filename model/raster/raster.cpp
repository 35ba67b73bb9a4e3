#include "model/raster/raster.h"

namespace splatscope::raster {

std::uint32_t tiles_touched(const TriangleSetup& setup) {
  if (!setup.covers) return 0;
  const int columns = ((setup.right - 1) >> 3) - (setup.left >> 3) + 1;
  const int rows = ((setup.bottom - 1) >> 3) - (setup.top >> 3) + 1;
  return static_cast<std::uint32_t>(columns) * static_cast<std::uint32_t>(rows);
}

}  // namespace splatscope::raster
