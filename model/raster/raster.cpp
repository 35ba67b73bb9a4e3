#include "model/raster/raster.h"

#include <cmath>

namespace splatscope::raster {

std::int64_t snap(double coordinate, int subpixel_bits) {
  return 2 * static_cast<std::int64_t>(std::floor(coordinate * static_cast<double>(1 << subpixel_bits)));
}

std::uint32_t tiles_touched(const TriangleSetup& setup) {
  if (!setup.covers) return 0;
  const int columns = ((setup.right - 1) >> 3) - (setup.left >> 3) + 1;
  const int rows = ((setup.bottom - 1) >> 3) - (setup.top >> 3) + 1;
  return static_cast<std::uint32_t>(columns) * static_cast<std::uint32_t>(rows);
}

}  // namespace splatscope::raster
