#include "kernels/reference/volume/transfer_function.h"

#include <algorithm>
#include <utility>

#include "model/error.h"

namespace splatscope::kernels {

TransferFunction::TransferFunction(std::vector<TransferPoint> points) : points_(std::move(points)) {
  if (points_.empty() || !std::ranges::is_sorted(points_, {}, &TransferPoint::value)) {
    throw ModelError("transfer function: no points, or values that fall");
  }
}

VoxelLook TransferFunction::operator()(double value) const {
  const auto after = std::ranges::upper_bound(points_, value, {}, &TransferPoint::value);
  if (after == points_.begin()) return points_.front().look;
  if (after == points_.end()) return points_.back().look;
  const TransferPoint& a = *(after - 1);
  const double t = (value - a.value) / (after->value - a.value);
  return {a.look.opacity + t * (after->look.opacity - a.look.opacity),
          a.look.color + t * (after->look.color - a.look.color)};
}

}  // namespace splatscope::kernels
