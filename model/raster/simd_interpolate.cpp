// Places of fragments and interpolation on SIMD registers, compiled once a target and chosen at run time
// (Highway).
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
                 std::size_t first, std::size_t end, const FragmentAttributes& out) {
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
        hn::StoreU(value, F{}, (*out[attribute])[c] + i);
      }
    }
  }
}

#if HWY_TARGET == HWY_SCALAR

std::size_t append_row(const Window& window, unsigned row, int left, int top, std::uint32_t width,
                       std::size_t count, FragmentPlaces& places) {
  for (unsigned bit = 16 * row; bit < 16 * (row + 1); ++bit) {
    if ((window.passed >> bit & 1u) == 0) continue;
    const int x = window.x + Window::x_of(bit), y = window.y + Window::y_of(bit);
    places.x[count] = static_cast<float>(x - left);
    places.y[count] = static_cast<float>(y - top);
    places.pixel[count++] = static_cast<std::uint32_t>(y) * width + static_cast<std::uint32_t>(x);
  }
  return count;
}

#else

using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;

HWY_INLINE std::size_t append_row(const Window& window, unsigned row, int left, int top, std::uint32_t width,
                                  std::size_t count, FragmentPlaces& places) {
  const auto passed = static_cast<std::uint32_t>(window.passed >> 16 * row & 0xffffu);
  const int y = window.y + 2 * static_cast<int>(row);
  const std::uint32_t first = static_cast<std::uint32_t>(y) * width + static_cast<std::uint32_t>(window.x);
  for (std::size_t lane = 0; lane < Window::kRowLanes; lane += hn::Lanes(F{})) {
    const std::uint32_t lanes = passed >> lane & (0xffffu >> (Window::kRowLanes - hn::Lanes(F{})));
    if (lanes == 0) continue;
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(lanes), static_cast<std::uint8_t>(lanes >> 8)};
    const auto lane_x = hn::Load(I{}, Window::kLaneX + lane), lane_y = hn::Load(I{}, Window::kLaneY + lane);
    const auto pixel =
        hn::Add(hn::Set(U{}, first),
                hn::Add(hn::BitCast(U{}, lane_x), hn::Mul(hn::BitCast(U{}, lane_y), hn::Set(U{}, width))));
    const auto to_float = [](auto numbers, int offset)
                              HWY_ATTR { return hn::ConvertTo(F{}, hn::Add(numbers, hn::Set(I{}, offset))); };
    const auto mask = hn::LoadMaskBits(F{}, bits);
    hn::StoreU(hn::Compress(to_float(lane_x, window.x - left), mask), F{}, places.x + count);
    hn::StoreU(hn::Compress(to_float(lane_y, y - top), mask), F{}, places.y + count);
    hn::StoreU(hn::Compress(pixel, hn::RebindMask(U{}, mask)), U{}, places.pixel + count);
    count += hwy::PopCount(lanes);
  }
  return count;
}

#endif

std::size_t append_places(const TriangleSetup& setup, std::span<const Window> windows, unsigned first_row,
                          unsigned end_row, std::uint32_t width, std::size_t count, FragmentPlaces& places) {
  for (unsigned row = first_row; row < end_row; ++row)
    for (const Window& window : windows)
      count = append_row(window, row, setup.left, setup.top, width, count, places);
  return count;
}

}  // namespace splatscope::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::raster {
HWY_EXPORT(interpolate);
HWY_EXPORT(append_places);

std::size_t append_places(const TriangleSetup& setup, std::span<const Window> windows, unsigned first_row,
                          unsigned end_row, std::uint32_t width, std::size_t count, FragmentPlaces& places) {
  return HWY_DYNAMIC_DISPATCH(append_places)(setup, windows, first_row, end_row, width, count, places);
}

void interpolate(const TriangleSetup& setup, const std::array<const Attributes*, 3>& corners,
                 std::span<const primitive::UsedAttribute> used, const FragmentPlaces& places,
                 std::size_t first, std::size_t end, const FragmentAttributes& out) {
  HWY_DYNAMIC_DISPATCH(interpolate)(setup, corners, used, places, first, end, out);
}
}  // namespace splatscope::raster
#endif
