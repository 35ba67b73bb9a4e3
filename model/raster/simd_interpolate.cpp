// Interpolation on SIMD registers, compiled once a target and chosen at run time (Highway).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/raster/simd_interpolate.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "model/raster/interpolate.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::raster::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, FragmentPlaces::kStride - FragmentPlaces::kCapacity>;
using V = hn::Vec<F>;

HWY_INLINE V at(const Plane& plane, V x, V y) {
  return hn::Add(hn::Set(F{}, plane.origin),
                 hn::Add(hn::Mul(hn::Set(F{}, plane.dx), x), hn::Mul(hn::Set(F{}, plane.dy), y)));
}

void interpolate(const TriangleSetup& setup, const std::array<const Attributes*, 3>& corners,
                 std::span<const primitive::UsedAttribute> used, const FragmentPlaces& places,
                 std::size_t first, std::size_t end, FragmentAttributes& out) {
  for (std::size_t i = first; i < end; i += hn::Lanes(F{})) {
    const V x = hn::LoadU(F{}, places.x + i), y = hn::LoadU(F{}, places.y + i);
    const V inverse_scale = hn::Div(hn::Set(F{}, 1.0f), at(setup.scale, x, y));
    const V b1 = hn::Mul(at(setup.weight1, x, y), inverse_scale);
    const V b2 = hn::Mul(at(setup.weight2, x, y), inverse_scale);
    for (const primitive::UsedAttribute& use : used) {
      const auto attribute = static_cast<std::size_t>(use.attribute);
      const Vec4 &a0 = (*corners[0])[attribute], &a1 = (*corners[1])[attribute],
                 &a2 = (*corners[2])[attribute];
      for (std::size_t c = 0; c < static_cast<std::size_t>(use.components); ++c) {
        // In this form an attribute that is the same at all corners stays exactly that.
        const V value = hn::Add(hn::Set(F{}, a0[c]), hn::Add(hn::Mul(b1, hn::Set(F{}, a1[c] - a0[c])),
                                                             hn::Mul(b2, hn::Set(F{}, a2[c] - a0[c]))));
        hn::StoreU(value, F{}, out.values[attribute][c] + i);
      }
    }
  }
}

}  // namespace splatscope::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::raster {
HWY_EXPORT(interpolate);

void interpolate(const TriangleSetup& setup, const std::array<const Attributes*, 3>& corners,
                 std::span<const primitive::UsedAttribute> used, const FragmentPlaces& places,
                 std::size_t first, std::size_t end, FragmentAttributes& out) {
  HWY_DYNAMIC_DISPATCH(interpolate)(setup, corners, used, places, first, end, out);
}
}  // namespace splatscope::raster
#endif
