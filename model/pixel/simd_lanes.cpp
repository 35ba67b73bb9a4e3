// The loops over the fragments of a batch on SIMD registers, compiled once a target and chosen at run time
// (Highway). Arrays have room behind for a whole register.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/pixel/simd_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "model/error.h"
#include "model/number/simd_steps-inl.h"
#include "model/pixel/registers.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::pixel::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kLaneStride - kBatch>;
using V = hn::Vec<F>;

HWY_INLINE V set(float value) {
  return hn::Set(F{}, value);
}

// registers.h's, to the sign of zero.
HWY_INLINE V in_range(V value, V low, V high) {
  const V number = hn::IfThenZeroElse(hn::IsNaN(value), value);
  return splatscope::HWY_NAMESPACE::within(number, low, high);
}

template <typename Function>
HWY_INLINE void each_lane(int count, Function function) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(F{})) function(i);
}

// function(component, lane) for the components that are written, as the register holds it.
template <typename Function>
HWY_INLINE void each(const Operation& operation, Lanes* result, int count, Function function) {
  const V scale = set(operation.scale), low = set(operation.format.low), high = set(operation.format.high);
  const V whole = set(255.0f);
  for (std::size_t component = 0; component < 4; ++component) {
    if (!(operation.mask & (1u << component))) continue;
    float* out = result[component];
    each_lane(count, [&](std::size_t i) HWY_ATTR {
      V value = in_range(hn::Mul(function(component, i), scale), low, high);
      // Such a register has one zero; and where a target rounds by adding, -0 comes out as +0 too.
      if (operation.format.steps)
        value = hn::Add(hn::Div(hn::Round(hn::Mul(value, whole)), whole), hn::Zero(F{}));
      hn::StoreU(value, F{}, out + i);
    });
  }
}

struct Reader {
  const Operand& operand;
  HWY_INLINE V operator()(std::size_t component, std::size_t i) const {
    return hn::LoadU(F{}, operand.component[component] + i);
  }
};

void compute(const Operation& operation, int count, Lanes* result) {
  const Reader a{operation.sources[0]}, b{operation.sources[1]}, c{operation.sources[2]};
  using std::size_t;
  const auto dot = [&](size_t terms, size_t i) HWY_ATTR {
    V sum = hn::Mul(a(0, i), b(0, i));
    for (size_t k = 1; k < terms; ++k) sum = hn::Add(sum, hn::Mul(a(k, i), b(k, i)));
    return sum;
  };
  switch (operation.opcode) {
    case isa::Opcode::mov:
      return each(operation, result, count, [&](size_t k, size_t i) HWY_ATTR { return a(k, i); });
    case isa::Opcode::add:
      return each(operation, result, count,
                  [&](size_t k, size_t i) HWY_ATTR { return hn::Add(a(k, i), b(k, i)); });
    case isa::Opcode::sub:
      return each(operation, result, count,
                  [&](size_t k, size_t i) HWY_ATTR { return hn::Sub(a(k, i), b(k, i)); });
    case isa::Opcode::mul:
      return each(operation, result, count,
                  [&](size_t k, size_t i) HWY_ATTR { return hn::Mul(a(k, i), b(k, i)); });
    case isa::Opcode::mad:
      return each(operation, result, count,
                  [&](size_t k, size_t i) HWY_ATTR { return hn::Add(hn::Mul(a(k, i), b(k, i)), c(k, i)); });
    case isa::Opcode::lrp:
      return each(operation, result, count, [&](size_t k, size_t i) HWY_ATTR {
        return hn::Add(hn::Mul(a(k, i), hn::Sub(b(k, i), c(k, i))), c(k, i));
      });
    case isa::Opcode::dp3:
      return each(operation, result, count, [&](size_t, size_t i) HWY_ATTR { return dot(3, i); });
    case isa::Opcode::dp4:
      return each(operation, result, count, [&](size_t, size_t i) HWY_ATTR { return dot(4, i); });
    case isa::Opcode::cnd:
      return each(operation, result, count, [&](size_t k, size_t i) HWY_ATTR {
        const V chosen_by = a(operation.select_by_alpha ? 3 : k, i);
        return hn::IfThenElse(hn::Gt(chosen_by, set(0.5f)), b(k, i), c(k, i));
      });
    case isa::Opcode::cmp:
      return each(operation, result, count, [&](size_t k, size_t i) HWY_ATTR {
        return hn::IfThenElse(hn::Ge(a(k, i), hn::Zero(F{})), b(k, i), c(k, i));
      });
    case isa::Opcode::bem:
      return each(operation, result, count, [&](size_t k, size_t i) HWY_ATTR {
        const V moved = hn::Add(a(k, i), hn::Mul(set(operation.bump[0][k]), b(0, i)));
        return hn::Add(moved, hn::Mul(set(operation.bump[1][k]), b(1, i)));
      });
    default:
      throw ModelError("not an arithmetic instruction of pixel programs");
  }
}

void clamp(const float* from, float low, float high, float* to, int count) {
  each_lane(count, [&](std::size_t i) HWY_ATTR {
    hn::StoreU(in_range(hn::LoadU(F{}, from + i), set(low), set(high)), F{}, to + i);
  });
}

void scale(const float* from, float scale, float offset, float* to, int count) {
  each_lane(count, [&](std::size_t i) HWY_ATTR {
    hn::StoreU(hn::Add(hn::Mul(hn::LoadU(F{}, from + i), set(scale)), set(offset)), F{}, to + i);
  });
}

}  // namespace splatscope::pixel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::pixel {
HWY_EXPORT(compute);
HWY_EXPORT(clamp);
HWY_EXPORT(scale);

void compute_lanes(const Operation& operation, int count, Lanes* result) {
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
