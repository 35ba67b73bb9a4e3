// The loops over the fragments of a batch, compiled once a target and chosen at run time (Highway): the
// compiler turns them into that target's SIMD instructions.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/pixel/simd_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <cmath>

#include "model/error.h"
#include "model/pixel/registers.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::pixel::HWY_NAMESPACE {

// function(component, lane) for the components that are written, as the register holds it.
template <typename Function>
HWY_INLINE void each(const Operation& operation, Register& result, int count, Function function) {
  const float scale = operation.scale, low = operation.format.low, high = operation.format.high;
  for (std::size_t component = 0; component < 4; ++component) {
    if (!(operation.mask & (1u << component))) continue;
    float* HWY_RESTRICT out = result.component[component];
    for (int i = 0; i < count; ++i)
      out[i] = in_range(function(component, static_cast<std::size_t>(i)) * scale, low, high);
    if (operation.format.steps)
      for (int i = 0; i < count; ++i) out[i] = std::nearbyint(out[i] * 255.0f) / 255.0f;
  }
}

void compute(const Operation& operation, int count, Register& result) {
  const auto& a = operation.sources[0].component;
  const auto& b = operation.sources[1].component;
  const auto& c = operation.sources[2].component;
  using std::size_t;
  switch (operation.opcode) {
    case isa::Opcode::mov:
      return each(operation, result, count, [&](size_t k, size_t i) { return a[k][i]; });
    case isa::Opcode::add:
      return each(operation, result, count, [&](size_t k, size_t i) { return a[k][i] + b[k][i]; });
    case isa::Opcode::sub:
      return each(operation, result, count, [&](size_t k, size_t i) { return a[k][i] - b[k][i]; });
    case isa::Opcode::mul:
      return each(operation, result, count, [&](size_t k, size_t i) { return a[k][i] * b[k][i]; });
    case isa::Opcode::mad:
      return each(operation, result, count, [&](size_t k, size_t i) { return a[k][i] * b[k][i] + c[k][i]; });
    case isa::Opcode::lrp:
      return each(operation, result, count,
                  [&](size_t k, size_t i) { return a[k][i] * (b[k][i] - c[k][i]) + c[k][i]; });
    case isa::Opcode::dp3:
      return each(operation, result, count, [&](size_t, size_t i) {
        return a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i];
      });
    case isa::Opcode::dp4:
      return each(operation, result, count, [&](size_t, size_t i) {
        return a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i] + a[3][i] * b[3][i];
      });
    case isa::Opcode::cnd:
      return each(operation, result, count, [&](size_t k, size_t i) {
        return (operation.select_by_alpha ? a[3][i] : a[k][i]) > 0.5f ? b[k][i] : c[k][i];
      });
    case isa::Opcode::cmp:
      return each(operation, result, count,
                  [&](size_t k, size_t i) { return a[k][i] >= 0.0f ? b[k][i] : c[k][i]; });
    case isa::Opcode::bem:
      return each(operation, result, count, [&](size_t k, size_t i) {
        return a[k][i] + operation.bump[0][k] * b[0][i] + operation.bump[1][k] * b[1][i];
      });
    default:
      throw ModelError("not an arithmetic instruction of pixel programs");
  }
}

void clamp(const float* from, float low, float high, float* to, int count) {
  for (int i = 0; i < count; ++i) to[i] = in_range(from[i], low, high);
}

void scale(const float* from, float scale, float offset, float* to, int count) {
  for (int i = 0; i < count; ++i) to[i] = from[i] * scale + offset;
}

}  // namespace splatscope::pixel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::pixel {
HWY_EXPORT(compute);
HWY_EXPORT(clamp);
HWY_EXPORT(scale);

void compute_lanes(const Operation& operation, int count, Register& result) {
  HWY_DYNAMIC_DISPATCH(compute)(operation, count, result);
}
void clamp_lanes(const float* from, float low, float high, float* to, int count) {
  HWY_DYNAMIC_DISPATCH(clamp)(from, low, high, to, count);
}
void scale_lanes(const float* from, float factor, float offset, float* to, int count) {
  HWY_DYNAMIC_DISPATCH(scale)(from, factor, offset, to, count);
}
}  // namespace splatscope::pixel
#endif
