// Coverage and depth of windows of 8x8 pixels, compiled once a target and chosen at run time (Highway). A
// register holds whole quads, in the order of Window's bits.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/raster/simd_windows.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "model/number/simd_mask-inl.h"
#include "model/number/simd_steps-inl.h"
#include "model/output/output.h"
#include "model/raster/raster.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::raster::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// An edge's value at a pixel, of which only the sign matters: kept where seven steps each way cannot
// overflow.
HWY_INLINE std::int32_t clamped(std::int64_t value) {
  constexpr std::int64_t kLimit = 1 << 30;
  return static_cast<std::int32_t>(std::clamp(value, -kLimit, kLimit));
}

#if HWY_TARGET == HWY_SCALAR

std::uint64_t cover(const TriangleSetup& setup, int x, int y) {
  std::uint64_t mask = 0;
  for (unsigned bit = 0; bit < 64; ++bit) {
    bool inside = true;
    for (const Edge& edge : setup.edges) {
      inside &= edge.origin + std::int64_t{edge.dx} * (x + Window::x_of(bit) - setup.left) +
                    std::int64_t{edge.dy} * (y + Window::y_of(bit) - setup.top) >=
                0;
    }
    mask |= std::uint64_t{inside} << bit;
  }
  return mask;
}

std::uint64_t test_depth(const TriangleSetup& setup, const DepthTarget& target, const Window& window,
                         std::uint32_t* stored, std::size_t stride) {
  std::uint64_t passed = 0;
  for (std::uint64_t left = window.covered; left != 0; left &= left - 1) {
    const auto bit = static_cast<unsigned>(std::countr_zero(left));
    const int x = Window::x_of(bit), y = Window::y_of(bit);
    const float z = setup.depth.at(static_cast<float>(window.x + x - setup.left),
                                   static_cast<float>(window.y + y - setup.top));
    const float behind = z > setup.nearest ? z : setup.nearest;  // also for NaN
    const float within = behind < setup.furthest ? behind : setup.furthest;
    const std::uint32_t depth = output::quantize_depth(within, target.format);
    std::uint32_t& old = stored[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x)];
    if (target.test && depth > old) continue;
    if (target.write) old = depth;
    passed |= std::uint64_t{1} << bit;
  }
  return passed;
}

#else

constexpr std::size_t kRowLanes = Window::kRowLanes;
using I = hn::CappedTag<std::int32_t, kRowLanes>;
using U = hn::RebindToUnsigned<I>;
using F = hn::RebindToFloat<I>;
using VI = hn::Vec<I>;
using VF = hn::Vec<F>;

using splatscope::HWY_NAMESPACE::bits_of;
using splatscope::HWY_NAMESPACE::mask_of;

// The pixels of a window inside of all edges.
HWY_INLINE std::uint64_t cover(const TriangleSetup& setup, int x, int y) {
  std::int32_t corner[3];
  for (std::size_t e = 0; e < 3; ++e) {
    const Edge& edge = setup.edges[e];
    corner[e] = clamped(edge.origin + std::int64_t{edge.dx} * (x - setup.left) +
                        std::int64_t{edge.dy} * (y - setup.top));
  }
  std::uint64_t mask = 0;
  for (std::size_t lane = 0; lane < kRowLanes; lane += hn::Lanes(I{})) {
    const VI lane_x = hn::Load(I{}, Window::kLaneX + lane), lane_y = hn::Load(I{}, Window::kLaneY + lane);
    VI value[3], step[3];
    for (std::size_t e = 0; e < 3; ++e) {
      const VI dx = hn::Set(I{}, setup.edges[e].dx), dy = hn::Set(I{}, setup.edges[e].dy);
      value[e] = hn::Add(hn::Set(I{}, corner[e]), hn::Add(hn::Mul(dx, lane_x), hn::Mul(dy, lane_y)));
      step[e] = hn::Add(dy, dy);
    }
    for (int row = 0; row < kWindow / 2; ++row) {  // all of them: to leave early costs more, unforeseeably
      const VI outside = hn::Or(hn::Or(value[0], value[1]), value[2]);
      const std::uint64_t inside = bits_of(I{}, hn::Gt(outside, hn::Set(I{}, -1)));
      mask |= inside << (16 * static_cast<std::size_t>(row) + lane);
      for (std::size_t e = 0; e < 3; ++e) value[e] = hn::Add(value[e], step[e]);
    }
  }
  return mask;
}

// Window z in [0, 1] as the depth buffer stores it: output::quantize_depth. `levels`: 2^n of a format of n
// bits, which floor(z (2^n - 1) + 1/2) goes to.
#if HWY_TARGET <= HWY_AVX3
// In one step, rounded toward zero: a float under 2^24 keeps the floor of what it comes from.
HWY_INLINE hn::Vec<U> quantize(VF z, VF levels) {
  const VF steps = hn::Sub(levels, hn::Set(F{}, 1.0f)), half = hn::Set(F{}, 0.5f);
  const VF sum{_mm512_fmadd_round_ps(z.raw, steps.raw, half.raw, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC)};
  return hn::BitCast(U{}, splatscope::HWY_NAMESPACE::integer(sum));
}
#else
// The floor of 2^n z - z + 1/2, of which 2^n z is exact: where its fraction f and z cross a half, it is off
// by one. f - 1/2 is exact where f reaches 1/2, and f + 1/2 where z does.
HWY_INLINE hn::Vec<U> quantize(VF z, VF levels) {
  const VF scaled = hn::Mul(z, levels), half = hn::Set(F{}, 0.5f);
  const VI whole = splatscope::HWY_NAMESPACE::integer(scaled);
  const VF fraction = hn::Sub(scaled, hn::ConvertTo(F{}, whole));
  const auto minus_one = [](auto mask) HWY_ATTR { return hn::BitCast(I{}, hn::VecFromMask(F{}, mask)); };
  const VI more = minus_one(hn::Ge(hn::Sub(fraction, half), z));
  const VI less = minus_one(hn::Lt(hn::Add(fraction, half), z));
  return hn::BitCast(U{}, hn::Add(hn::Sub(whole, more), less));
}
#endif

// Places of pairs of pixels: of two rows that stand one after the other, quad by quad; and back.
struct Order {
  alignas(64) std::int32_t quads_of_rows[kRowLanes], rows_of_quads[kRowLanes];
};
constexpr Order make_order(std::size_t lanes) {
  Order order{};
  const std::size_t pairs = lanes / 2;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const std::size_t pair = lane / 2;
    order.quads_of_rows[lane] = static_cast<std::int32_t>((pair / 2 + pair % 2 * (pairs / 2)) * 2 + lane % 2);
    order.rows_of_quads[lane] =
        static_cast<std::int32_t>((pair % (pairs / 2) * 2 + pair / (pairs / 2)) * 2 + lane % 2);
  }
  return order;
}
constexpr Order kOrder = make_order(hn::MaxLanes(I{}));

// Tests the covered pixels of a window against `stored`, which holds all of its rows `stride` apart. All is
// read before anything is written: a processor makes reads wait for writes a power of two bytes away.
HWY_INLINE std::uint64_t test_depth(const TriangleSetup& setup, const DepthTarget& target,
                                    const Window& window, std::uint32_t* stored, std::size_t stride) {
  constexpr std::size_t kLanes = hn::MaxLanes(I{}), kBlocks = 64 / kLanes;
  const hn::Half<U> half;
  const auto to_quads = hn::SetTableIndices(U{}, kOrder.quads_of_rows);
  const auto to_rows = hn::SetTableIndices(U{}, kOrder.rows_of_quads);
  const auto place_of = [&](std::size_t block) {  // of its upper row
    const std::size_t bit = block * kLanes;
    return stored + bit / kRowLanes * 2 * stride + bit % kRowLanes / 2;
  };
  hn::Vec<U> old[kBlocks];
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::uint32_t* upper = place_of(block);
    old[block] = hn::Combine(U{}, hn::LoadU(half, upper + stride), hn::LoadU(half, upper));
  }
  const VF origin = hn::Set(F{}, setup.depth.origin), dx = hn::Set(F{}, setup.depth.dx),
           dy = hn::Set(F{}, setup.depth.dy);
  // In [0, 1] like what is stored; what is not positive becomes a zero without a sign.
  const VF nearest = hn::Set(F{}, setup.nearest > 0 ? std::min(setup.nearest, 1.0f) : 0.0f),
           furthest = hn::Set(F{}, setup.furthest > 0 ? std::min(setup.furthest, 1.0f) : 0.0f);
  // Copies: for all that the compiler knows, a store to the depth buffer changes `target`.
  const bool tests = target.test, writes = target.write, fixed_point = target.format != DepthFormat::float32;
  const VF levels = hn::Set(F{}, target.format == DepthFormat::z16 ? 0x1p16f : 0x1p24f);
  // A row of four quads is kParts registers wide; y is the same in each.
  constexpr std::size_t kParts = kRowLanes / kLanes;
  const auto from = [](const std::int32_t* lanes, int offset) HWY_ATTR {
    return hn::ConvertTo(F{}, hn::Add(hn::Load(I{}, lanes), hn::Set(I{}, offset)));
  };
  const VF y = from(Window::kLaneY, window.y - setup.top);
  VF along_x[kParts];
  for (std::size_t part = 0; part < kParts; ++part)
    along_x[part] = hn::Mul(dx, from(Window::kLaneX + part * kLanes, window.x - setup.left));
  std::uint64_t passed = 0;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::size_t bit = block * kLanes, lane = bit % kRowLanes;
    const std::uint64_t covered = window.covered >> bit & (~std::uint64_t{0} >> (64 - kLanes));
    if (covered == 0) continue;
    const VF row = hn::Set(F{}, static_cast<float>(bit / kRowLanes * 2));
    const VF along_y = hn::Mul(dy, hn::Add(y, row));
    const VF z = hn::Add(origin, hn::Add(along_x[lane / kLanes], along_y));
    const VF within = splatscope::HWY_NAMESPACE::within(z, nearest, furthest);
    const auto depth = fixed_point ? quantize(within, levels) : hn::BitCast(U{}, within);
    const auto quads = hn::TableLookupLanes(old[block], to_quads);
    auto pass = mask_of(U{}, covered);
    if (tests) pass = hn::AndNot(hn::Gt(depth, quads), pass);
    if (writes) {
      const auto rows = hn::TableLookupLanes(hn::IfThenElse(pass, depth, quads), to_rows);
      hn::StoreU(hn::LowerHalf(half, rows), half, place_of(block));
      hn::StoreU(hn::UpperHalf(half, rows), half, place_of(block) + stride);
    }
    passed |= bits_of(U{}, pass) << bit;
  }
  return passed;
}

#endif

// Pixels of a window in the columns (rows) from `first` to `end`, window coordinates.
constexpr std::uint64_t columns(int first, int end) {
  std::uint64_t row = 0;
  for (unsigned bit = 0; bit < 16; ++bit) {
    const int x = Window::x_of(bit);
    if (x >= first && x < end) row |= std::uint64_t{1} << bit;
  }
  return row * 0x0001000100010001u;
}
constexpr std::uint64_t rows(int first, int end) {
  std::uint64_t mask = 0;
  for (unsigned bit = 0; bit < 64; ++bit) {
    const int y = Window::y_of(bit);
    if (y >= first && y < end) mask |= std::uint64_t{1} << bit;
  }
  return mask;
}
struct Halves {
  std::uint64_t columns_from[2], columns_to[kWindow + 1], rows_from[2], rows_to[kWindow + 1];
};
constexpr Halves make_halves() {
  Halves halves{};
  for (int first = 0; first < 2; ++first) {
    halves.columns_from[first] = columns(first, kWindow);
    halves.rows_from[first] = rows(first, kWindow);
  }
  for (int end = 0; end <= kWindow; ++end) {
    halves.columns_to[end] = columns(0, end);
    halves.rows_to[end] = rows(0, end);
  }
  return halves;
}
constexpr Halves kHalves = make_halves();

// The pixels of a window within the triangle's rectangle.
HWY_INLINE std::uint64_t in_rectangle(const TriangleSetup& setup, int x, int y) {
  return kHalves.columns_from[std::max(setup.left - x, 0)] &
         kHalves.columns_to[std::min(setup.right - x, kWindow)] &
         kHalves.rows_from[std::max(setup.top - y, 0)] & kHalves.rows_to[std::min(setup.bottom - y, kWindow)];
}

// test_depth where the window reaches over the edge of the frame: on a copy.
std::uint64_t test_depth_at_edge(const TriangleSetup& setup, const DepthTarget& target,
                                 const Window& window) {
  std::uint32_t copy[kWindow * kWindow] = {};
  const std::size_t width = target.viewport.width;
  const int columns = std::min(static_cast<int>(width) - window.x, kWindow);
  const int rows = std::min(static_cast<int>(target.viewport.height) - window.y, kWindow);
  const auto row_of = [&](int row) {
    return target.values.data() + static_cast<std::size_t>(window.y + row) * width +
           static_cast<std::size_t>(window.x);
  };
  for (int row = 0; row < rows; ++row) std::copy_n(row_of(row), columns, copy + row * kWindow);
  const std::uint64_t passed = test_depth(setup, target, window, copy, kWindow);
  for (int row = 0; row < rows; ++row) std::copy_n(copy + row * kWindow, columns, row_of(row));
  return passed;
}

// Quads of a window with any of `pixels`.
HWY_INLINE std::uint32_t quads_of(std::uint64_t pixels) {
  const std::uint64_t pairs = pixels | pixels >> 1;
  return static_cast<std::uint32_t>(hwy::PopCount((pairs | pairs >> 2) & 0x1111111111111111u));
}

BandCounts rasterize_band(const TriangleSetup& setup, const DepthTarget& depth, int y,
                          std::span<Window, kMaxWindows> out) {
  const int width = static_cast<int>(depth.viewport.width), height = static_cast<int>(depth.viewport.height);
  BandCounts counts;
  for (int x = setup.left & ~1; x < setup.right; x += kWindow) {
    Window window{x, y, cover(setup, x, y), 0};
    // What is inside of all edges lies within the rectangle, but for the frame's edges.
    const bool in_frame = x + kWindow <= width && y + kWindow <= height;
    if (!in_frame) window.covered &= in_rectangle(setup, x, y);
    if (window.covered == 0) continue;
    if (!depth.test && !depth.write) {
      window.passed = window.covered;
    } else if (in_frame) {
      std::uint32_t* stored = depth.values.data() + static_cast<std::size_t>(y) * depth.viewport.width +
                              static_cast<std::size_t>(x);
      window.passed = test_depth(setup, depth, window, stored, depth.viewport.width);
    } else {
      window.passed = test_depth_at_edge(setup, depth, window);
    }
    out[counts.windows++] = window;
    counts.covered += static_cast<std::uint32_t>(hwy::PopCount(window.covered));
    counts.passed += static_cast<std::uint32_t>(hwy::PopCount(window.passed));
    counts.quads += quads_of(window.covered);
    counts.quads_passed += quads_of(window.passed);
  }
  return counts;
}

}  // namespace splatscope::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::raster {
HWY_EXPORT(rasterize_band);

BandCounts rasterize_band(const TriangleSetup& setup, const DepthTarget& depth, int y,
                          std::span<Window, kMaxWindows> out) {
  return HWY_DYNAMIC_DISPATCH(rasterize_band)(setup, depth, y, out);
}
}  // namespace splatscope::raster
#endif
