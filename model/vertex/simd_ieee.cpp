// The ieee arithmetic on SIMD registers, compiled once a target and chosen at run time (Highway). Every
// target gives the bits of run_scalar: IEEE operations in the same order, and lanes whose result is a NaN go
// through run_scalar itself, because which NaN an instruction returns differs between targets and compilers.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/vertex/simd_ieee.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "model/vertex/steps.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::vertex::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kBroadcast>;
using V = hn::Vec<F>;
constexpr std::size_t kComponents = 4;

// Reads of one operand for the vertices from `i`.
struct Reader {
  explicit Reader(const Operand& operand)
      : operand(operand), sign(hn::BitCast(F{}, hn::Set(hn::RebindToUnsigned<F>{}, operand.sign))) {}
  V operator()(std::size_t component, std::size_t i) const {
    return hn::Xor(hn::Load(F{}, operand.component[component] + i * operand.stride), sign);
  }
  const Operand& operand;
  V sign;
};

// Whether `value` is free of NaN; else the vertices from `i` go to the scalar code.
HWY_INLINE bool all_numbers(const Call& call, std::size_t i, V value) {
  if (HWY_LIKELY(hn::AllFalse(F{}, hn::IsNaN(value)))) return true;
  run_scalar(call, Arithmetic::ieee, static_cast<int>(i), static_cast<int>(i + hn::Lanes(F{})));
  return false;
}

HWY_INLINE void put(const Call& call, std::size_t k, std::size_t i, V result) {
  hn::Store(result, F{}, call.destination + call.components[k] * kBatch + i);
}

// The same scalar for every component that is written.
template <typename Function>
HWY_INLINE void one_scalar(const Call& call, std::size_t count, Function function) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(F{})) {
    const V scalar = function(i);
    if (!all_numbers(call, i, scalar)) continue;
    for (std::size_t k = 0; k < call.component_count; ++k) put(call, k, i, scalar);
  }
}

template <std::size_t kCount, typename Function>
HWY_INLINE void each_of(const Call& call, std::size_t count, Function function) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(F{})) {
    V results[kCount];
    for (std::size_t k = 0; k < kCount; ++k) results[k] = function(call.components[k], i);
    V sum = results[0];  // NaN where one of them is, or where two infinities cancel
    for (std::size_t k = 1; k < kCount; ++k) sum = hn::Add(sum, results[k]);
    if (!all_numbers(call, i, sum)) continue;
    for (std::size_t k = 0; k < kCount; ++k) put(call, k, i, results[k]);
  }
}

// result[c] = function(component c) for the components that are written.
template <typename Function>
HWY_INLINE void each_component(const Call& call, std::size_t count, Function function) {
  switch (call.component_count) {
    case 1:
      return one_scalar(call, count, [&](std::size_t i) HWY_ATTR { return function(call.components[0], i); });
    case 2:
      return each_of<2>(call, count, function);
    case 3:
      return each_of<3>(call, count, function);
    default:
      return each_of<4>(call, count, function);
  }
}

HWY_INLINE V dot(const Reader& a, const Reader& b, std::size_t length, std::size_t i) {
  V sum = hn::Mul(a(0, i), b(0, i));
  for (std::size_t c = 1; c < length; ++c) sum = hn::Add(sum, hn::Mul(a(c, i), b(c, i)));
  return sum;
}

// 1/sqrt in double, rounded once. Half the lanes at a time.
void reciprocal_sqrt(const Call& call, std::size_t count) {
  const hn::CappedTag<double, kBroadcast / 2> wide;
  const hn::Rebind<float, decltype(wide)> narrow;
  const Operand& a = call.sources[0];
  HWY_ALIGN float results[kBatch];
  for (std::size_t i = 0; i < count; i += hn::Lanes(wide)) {
    const auto magnitude = hn::Abs(hn::PromoteTo(wide, hn::Load(narrow, a.component[0] + i * a.stride)));
    hn::Store(hn::DemoteTo(narrow, hn::Div(hn::Set(wide, 1.0), hn::Sqrt(magnitude))), narrow, results + i);
  }
  // DemoteTo clamps the INF of a zero to the largest finite value on some targets.
  const V infinity = hn::Inf(F{});
  const Reader source(a);
  one_scalar(call, count, [&](std::size_t i) HWY_ATTR {
    return hn::IfThenElse(hn::Eq(source(0, i), hn::Zero(F{})), infinity, hn::Load(F{}, results + i));
  });
}

void run_ieee(const Call& call, int vertices) {
  const std::size_t lanes = hn::Lanes(F{});
  const std::size_t count = (static_cast<std::size_t>(vertices) + lanes - 1) / lanes * lanes;
  const Reader a(call.sources[0]), b(call.sources[1]), c(call.sources[2]);
  const V one = hn::Set(F{}, 1.0f);
  switch (call.operation) {
    case Operation::move:
      for (std::size_t i = 0; i < count; i += lanes) {  // raw bits: a NaN is moved, not computed
        V values[kComponents];
        for (std::size_t k = 0; k < call.component_count; ++k) values[k] = a(call.components[k], i);
        for (std::size_t k = 0; k < call.component_count; ++k) put(call, k, i, values[k]);
      }
      return;
    case Operation::add:
      return each_component(call, count,
                            [&](std::size_t k, std::size_t i) HWY_ATTR { return hn::Add(a(k, i), b(k, i)); });
    case Operation::multiply:
      return each_component(call, count,
                            [&](std::size_t k, std::size_t i) HWY_ATTR { return hn::Mul(a(k, i), b(k, i)); });
    case Operation::multiply_add:
      return each_component(call, count, [&](std::size_t k, std::size_t i) HWY_ATTR {
        return hn::Add(hn::Mul(a(k, i), b(k, i)), c(k, i));
      });
    case Operation::dot3:
      return one_scalar(call, count, [&](std::size_t i) HWY_ATTR { return dot(a, b, 3, i); });
    case Operation::dot4:
      return one_scalar(call, count, [&](std::size_t i) HWY_ATTR { return dot(a, b, 4, i); });
    case Operation::minimum:
      return each_component(call, count, [&](std::size_t k, std::size_t i) HWY_ATTR {
        const V x = a(k, i), y = b(k, i);
        return hn::IfThenElse(hn::Lt(x, y), x, y);
      });
    case Operation::maximum:
      return each_component(call, count, [&](std::size_t k, std::size_t i) HWY_ATTR {
        const V x = a(k, i), y = b(k, i);
        return hn::IfThenElse(hn::Ge(x, y), x, y);
      });
    case Operation::less:
      return each_component(call, count, [&](std::size_t k, std::size_t i) HWY_ATTR {
        return hn::IfThenElseZero(hn::Lt(a(k, i), b(k, i)), one);
      });
    case Operation::greater_equal:
      return each_component(call, count, [&](std::size_t k, std::size_t i) HWY_ATTR {
        return hn::IfThenElseZero(hn::Ge(a(k, i), b(k, i)), one);
      });
    case Operation::reciprocal:
      return one_scalar(call, count, [&](std::size_t i) HWY_ATTR { return hn::Div(one, a(0, i)); });
    case Operation::reciprocal_sqrt:
      return reciprocal_sqrt(call, count);
    default:
      return run_scalar(call, Arithmetic::ieee, 0, vertices);
  }
}

}  // namespace splatscope::vertex::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::vertex {
HWY_EXPORT(run_ieee);

void run_simd_ieee(const Call& call, int count) {
  HWY_DYNAMIC_DISPATCH(run_ieee)(call, count);
}
}  // namespace splatscope::vertex
#endif
