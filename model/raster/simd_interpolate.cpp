// Places of fragments and interpolation on SIMD registers, compiled once a target and chosen at run time
// (Highway).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/raster/simd_interpolate.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "model/number/simd_mask-inl.h"
#include "model/raster/interpolate.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::raster::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kFragmentStride - kFragments>;
using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;
using V = hn::Vec<F>;
using VU = hn::Vec<U>;
using Places = std::span<const std::uint32_t, kFragmentStride>;

HWY_INLINE V at(const Plane& plane, V x, V y) {
  return hn::Add(hn::Set(F{}, plane.origin),
                 hn::Add(hn::Mul(hn::Set(F{}, plane.dx), x), hn::Mul(hn::Set(F{}, plane.dy), y)));
}

HWY_INLINE VU x_of(VU place) {
  return hn::And(place, hn::Set(U{}, 0xffffu));
}
HWY_INLINE VU y_of(VU place) {
  return hn::ShiftRight<16>(place);
}

HWY_INLINE void interpolate_piece(const FragmentsOfPiece& fragments,
                                  std::span<const primitive::UsedAttribute> used,
                                  const VertexAttributes& vertices, Places places,
                                  const FragmentAttributes& out) {
  const TriangleSetup& setup = *fragments.piece.setup;
  const auto [corner0, corner1, corner2] = fragments.piece.corners;
  const auto from = [](VU numbers, int origin) HWY_ATTR {
    return hn::ConvertTo(F{}, hn::Sub(hn::BitCast(I{}, numbers), hn::Set(I{}, origin)));
  };
  for (std::size_t i = fragments.first; i < fragments.end; i += hn::Lanes(F{})) {
    const VU place = hn::LoadU(U{}, places.data() + i);
    const V x = from(x_of(place), setup.left), y = from(y_of(place), setup.top);
    const V inverse_scale = hn::Div(hn::Set(F{}, 1.0f), at(setup.scale, x, y));
    const V b1 = hn::Mul(at(setup.weight1, x, y), inverse_scale);
    const V b2 = hn::Mul(at(setup.weight2, x, y), inverse_scale);
    for (const primitive::UsedAttribute& use : used) {
      const auto attribute = static_cast<std::size_t>(use.attribute);
      for (std::size_t c = 0; c < static_cast<std::size_t>(use.components); ++c) {
        const float* values = vertices[attribute][c].data();
        const float a0 = values[corner0], a1 = values[corner1], a2 = values[corner2];
        // In this form an attribute that is the same at all corners stays exactly that.
        const V value = hn::Add(hn::Set(F{}, a0), hn::Add(hn::Mul(b1, hn::Set(F{}, a1 - a0)),
                                                          hn::Mul(b2, hn::Set(F{}, a2 - a0))));
        hn::StoreU(value, F{}, (*out[attribute])[c] + i);
      }
    }
  }
}

void interpolate(std::span<const FragmentsOfPiece> pieces, std::span<const primitive::UsedAttribute> used,
                 const VertexAttributes& vertices, Places places, std::size_t count, std::uint32_t width,
                 std::span<std::uint32_t, kFragmentStride> pixels, const FragmentAttributes& out) {
  for (const FragmentsOfPiece& fragments : pieces) interpolate_piece(fragments, used, vertices, places, out);
  for (std::size_t i = 0; i < count; i += hn::Lanes(U{})) {
    const VU place = hn::LoadU(U{}, places.data() + i);
    const VU row = hn::Mul(y_of(place), hn::Set(U{}, width));
    hn::StoreU(hn::Add(row, x_of(place)), U{}, pixels.data() + i);
  }
}

HWY_INLINE std::size_t append_lanes(std::uint32_t passed, std::size_t first_lane, std::uint32_t origin,
                                    std::uint32_t* out) {
  const auto x = hn::Load(I{}, Window::kLaneX + first_lane), y = hn::Load(I{}, Window::kLaneY + first_lane);
  const VU from_origin = hn::BitCast(U{}, hn::Or(x, hn::ShiftLeft<16>(y)));
  const VU places = hn::Add(from_origin, hn::Set(U{}, origin));
  hn::StoreU(hn::Compress(places, splatscope::HWY_NAMESPACE::mask_of(U{}, passed)), U{}, out);
  return hwy::PopCount(passed);
}

std::size_t append_places(const Window& window, std::size_t count,
                          std::span<std::uint32_t, kFragmentStride> places) {
  constexpr std::size_t kLanes = hn::MaxLanes(U{});
  constexpr std::uint32_t kLaneBits = 0xffffu >> (Window::kRowLanes - kLanes);
  for (unsigned row = 0; row < kWindow / 2; ++row) {
    const auto origin = static_cast<std::uint32_t>(window.x + ((window.y + 2 * static_cast<int>(row)) << 16));
    const std::uint32_t passed = Window::row(window.passed, row);
    // Also where none passed: that cannot be foreseen.
    for (std::size_t lane = 0; lane < Window::kRowLanes; lane += kLanes)
      count += append_lanes(passed >> lane & kLaneBits, lane, origin, places.data() + count);
  }
  return count;
}

}  // namespace splatscope::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::raster {
HWY_EXPORT(interpolate);
HWY_EXPORT(append_places);

std::size_t append_places(const Window& window, std::size_t count,
                          std::span<std::uint32_t, kFragmentStride> places) {
  return HWY_DYNAMIC_DISPATCH(append_places)(window, count, places);
}

void interpolate(std::span<const FragmentsOfPiece> pieces, std::span<const primitive::UsedAttribute> used,
                 const VertexAttributes& vertices, std::span<const std::uint32_t, kFragmentStride> places,
                 std::size_t count, std::uint32_t width, std::span<std::uint32_t, kFragmentStride> pixels,
                 const FragmentAttributes& out) {
  HWY_DYNAMIC_DISPATCH(interpolate)(pieces, used, vertices, places, count, width, pixels, out);
}
}  // namespace splatscope::raster
#endif
