// The NV20's arithmetic on SIMD registers, compiled once a target and chosen at run time (Highway). Bit for
// bit that of model/number/nv20.h, by the processor's own arithmetic rounding toward zero (Nv20Mode) and by
// integers. Lanes with an INF, NaN or denormal operand go through run_scalar.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/vertex/simd_nv20.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "model/number/nv20.h"
#include "model/number/simd_steps-inl.h"
#include "model/vertex/steps.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::vertex::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128 || !HWY_ARCH_X86_64

void run_nv20(const Call& call, int vertices) {
  run_scalar(call, Arithmetic::nv20, 0, vertices);
}

bool holds_special(const float*, std::size_t) {
  return true;
}

#else
namespace hn = hwy::HWY_NAMESPACE;

using U = hn::CappedTag<std::uint32_t, kBroadcast>;
using I = hn::RebindToSigned<U>;
using F = hn::RebindToFloat<U>;
using W = hn::Repartition<std::uint64_t, U>;  // pairs of lanes
using V = hn::Vec<U>;
using VI = hn::Vec<I>;
using VF = hn::Vec<F>;
constexpr std::size_t kComponents = 4;

HWY_INLINE V set(std::uint32_t value) {
  return hn::Set(U{}, value);
}
HWY_INLINE VI as_signed(V value) {
  return hn::BitCast(I{}, value);
}
HWY_INLINE V as_unsigned(VI value) {
  return hn::BitCast(U{}, value);
}

HWY_INLINE V sign_of(V a) {
  return hn::And(a, set(0x80000000u));
}
HWY_INLINE V exponent_of(V a) {
  return hn::And(hn::ShiftRight<23>(a), set(0xff));
}
HWY_INLINE V fraction_of(V a) {
  return hn::And(a, set(0x7fffff));
}

// The 64-bit products of even and of odd lanes.
struct Wide {
  hn::Vec<W> even, odd;
};
HWY_INLINE Wide multiply_wide(V a, V b) {
  const auto odd = [](V v) HWY_ATTR { return hn::BitCast(U{}, hn::ShiftRight<32>(hn::BitCast(W{}, v))); };
  return {hn::MulEven(a, b), hn::MulEven(odd(a), odd(b))};
}
template <typename Function>
HWY_INLINE Wide each_half(Wide a, Function function) {
  return {function(a.even), function(a.odd)};
}
// The low halves of 64-bit lanes back in the places of their factors.
HWY_INLINE V narrow(Wide a) {
  return hn::Or(hn::BitCast(U{}, hn::And(a.even, hn::Set(W{}, 0xffffffffu))),
                hn::BitCast(U{}, hn::ShiftLeft<32>(a.odd)));
}
HWY_INLINE V high_product(V a, V b) {
  const Wide product = multiply_wide(a, b);
  const auto high = hn::Set(W{}, 0xffffffff00000000u);
  return hn::Or(hn::BitCast(U{}, hn::ShiftRight<32>(product.even)),
                hn::BitCast(U{}, hn::And(product.odd, high)));
}

// nv20's pack: `significand` has its top bit at 23, `exponent` is a signed number.
HWY_INLINE V pack(V sign, VI exponent, V significand) {
  const V finite = hn::Or(hn::ShiftLeft<23>(as_unsigned(exponent)), fraction_of(significand));
  const V in_range =
      hn::IfThenElse(hn::MaskFromVec(as_unsigned(hn::VecFromMask(I{}, hn::Gt(exponent, hn::Set(I{}, 254))))),
                     set(0x7f7fffff), finite);
  const auto positive = hn::MaskFromVec(as_unsigned(hn::VecFromMask(I{}, hn::Gt(exponent, hn::Zero(I{})))));
  return hn::Or(sign, hn::IfThenElseZero(positive, in_range));
}

HWY_INLINE VF as_float(V value) {
  return hn::BitCast(F{}, value);
}

// Whether a lane is an INF, a NaN or a denormal.
HWY_INLINE bool any_special(V value) {
  const V magnitude = hn::And(value, set(0x7fffffff));
  const V zero_is_normal =
      hn::IfThenZeroElse(hn::Eq(magnitude, hn::Zero(U{})), hn::Sub(magnitude, set(0x00800000)));
  return !hn::AllTrue(U{}, hn::Lt(zero_is_normal, set(0x7f000000)));
}

// Toward zero; what is too large becomes the largest number and what is too small 0, both with their sign:
// all of it the processor's mode. A zero factor gives +0 instead.
HWY_INLINE V multiply(V a, V b) {
  const VF x = as_float(a), y = as_float(b), zero = hn::Zero(F{});
  return hn::BitCast(U{}, hn::IfThenZeroElse(hn::Or(hn::Eq(x, zero), hn::Eq(y, zero)), hn::Mul(x, y)));
}

// nv20's sum: the terms as integers in units of 2^-28 of the largest one's power of two, each toward zero,
// and their exact sum toward zero as a float. Terms under kSmallest, which the scales do not reach, are
// noted.
constexpr std::uint32_t kSmallest = 29u << 23;  // as bits: 2^-98
template <std::size_t kTerms>
HWY_INLINE V sum(const VF (&terms)[kTerms], V& least) {
  V largest = hn::BitCast(U{}, hn::Abs(terms[0]));
  for (std::size_t k = 1; k < kTerms; ++k) largest = hn::Max(largest, hn::BitCast(U{}, hn::Abs(terms[k])));
  least = hn::Min(least, hn::Sub(largest, set(1)));  // 0 is then the greatest number
  const V power = hn::And(hn::Max(largest, set(kSmallest)), set(0x7f800000));
  const VF scale = as_float(hn::Sub(set((127u + 28 + 127) << 23), power));
  VI total = splatscope::HWY_NAMESPACE::integer(hn::Mul(terms[0], scale));
  for (std::size_t k = 1; k < kTerms; ++k)
    total = hn::Add(total, splatscope::HWY_NAMESPACE::integer(hn::Mul(terms[k], scale)));
  const VF unit = as_float(hn::Sub(power, set(28u << 23)));
  return hn::BitCast(U{}, hn::Mul(hn::ConvertTo(F{}, total), unit));
}

HWY_INLINE V order(V a) {
  const V negative = as_unsigned(hn::ShiftRight<31>(as_signed(a)));
  return hn::Xor(a, hn::Or(negative, set(0x80000000u)));
}

HWY_INLINE V look_up(const std::uint32_t* table, V index) {
  return hn::GatherIndex(U{}, table, as_signed(index));
}

// nv20::reciprocal of finite lanes.
HWY_INLINE V reciprocal(V a) {
  const V fraction = fraction_of(a), exponent = exponent_of(a), sign = sign_of(a);
  const V significand = hn::Or(fraction, set(1u << 23));
  const V s0 = look_up(nv20::reciprocal_seeds().data(), hn::ShiftRight<17>(fraction));
  const V s1 = high_product(hn::Sub(set(1u << 31), hn::Mul(s0, significand)), hn::ShiftLeft<8>(s0));
  const Wide product = multiply_wide(s1, significand);
  // (2^37 - s1*F) * s1 in two halves of 32 bits, of which the upper is under 2^6.
  const auto left =
      each_half(product, [](auto p) HWY_ATTR { return hn::Sub(hn::Set(W{}, std::uint64_t{1} << 37), p); });
  const V low = narrow(left);
  const V high = narrow(each_half(left, [](auto p) HWY_ATTR { return hn::ShiftRight<32>(p); }));
  const Wide low_product = multiply_wide(low, s1), high_part = multiply_wide(high, s1);
  const Wide total = {hn::Add(low_product.even, hn::ShiftLeft<32>(high_part.even)),
                      hn::Add(low_product.odd, hn::ShiftLeft<32>(high_part.odd))};
  const V s2 = narrow(each_half(total, [](auto p) HWY_ATTR { return hn::ShiftRight<25>(p); }));
  const auto power_of_two = hn::Eq(fraction, hn::Zero(U{}));
  const V steps = hn::IfThenElse(power_of_two, set(0xfe), set(0xfd));
  const V result = pack(sign, as_signed(hn::Sub(steps, exponent)), hn::IfThenZeroElse(power_of_two, s2));
  return hn::IfThenElse(hn::Eq(exponent, hn::Zero(U{})), hn::Or(sign, set(0x7f800000)), result);
}

// nv20::reciprocal_sqrt of finite lanes.
HWY_INLINE V reciprocal_sqrt(V a) {
  const V fraction = fraction_of(a), exponent = exponent_of(a), implicit = set(1u << 23);
  const auto odd_power = hn::Eq(hn::And(exponent, set(1)), hn::Zero(U{}));
  const V odd = hn::IfThenElseZero(odd_power, set(1));
  const V index = hn::ShiftRight<17>(hn::Or(fraction, hn::IfThenElseZero(odd_power, implicit)));
  const V base = hn::Or(fraction, implicit);
  const V significand = hn::IfThenElse(odd_power, hn::ShiftLeft<1>(base), base);
  const V s0 = look_up(nv20::reciprocal_sqrt_seeds().data(), index);
  const auto step = [](V s, V f, std::uint64_t three) HWY_ATTR {
    // (three - s*s*F) * s, where s*s fits 32 bits
    const auto left = each_half(multiply_wide(hn::Mul(s, s), f),
                                [=](auto p) HWY_ATTR { return hn::Sub(hn::Set(W{}, three), p); });
    const V low = narrow(left);
    const V high = narrow(each_half(left, [](auto p) HWY_ATTR { return hn::ShiftRight<32>(p); }));
    const Wide low_product = multiply_wide(low, s), high_part = multiply_wide(high, s);
    return Wide{hn::Add(low_product.even, hn::ShiftLeft<32>(high_part.even)),
                hn::Add(low_product.odd, hn::ShiftLeft<32>(high_part.odd))};
  };
  const V s1 = narrow(each_half(step(s0, significand, std::uint64_t{3} << 37),
                                [](auto p) HWY_ATTR { return hn::ShiftRight<32>(p); }));
  const V s2 = narrow(each_half(step(s1, significand, std::uint64_t{3} << 49),
                                [](auto p) HWY_ATTR { return hn::ShiftRight<39>(p); }));
  // 127 - (e - 127 - odd)/2 - 1, an exact division, kept positive: 190 - (e + 1 - odd)/2
  const V half = hn::ShiftRight<1>(hn::Sub(hn::Add(exponent, set(1)), odd));
  const V result = pack(hn::Zero(U{}), as_signed(hn::Sub(set(190), half)), s2);
  return hn::IfThenElse(hn::Eq(exponent, hn::Zero(U{})), set(0x7f800000), result);
}

// Reads of one operand for the vertices from `i`. kNegates: some source of the call is negated; without it a
// load folds into what uses it.
template <bool kNegates>
struct Reader {
  explicit Reader(const Operand& operand) : operand(operand), sign(set(operand.sign)) {}
  V operator()(std::size_t component, std::size_t i) const {
    const auto* bits =
        reinterpret_cast<const std::uint32_t*>(operand.component[component] + i * operand.stride);
    const V value = hn::Load(U{}, bits);
    return kNegates ? hn::Xor(value, sign) : value;
  }
  VF number(std::size_t component, std::size_t i) const { return as_float((*this)(component, i)); }
  const Operand& operand;
  V sign;
};

template <bool kNegates>
struct Sources {
  explicit Sources(const Call& call) : a(call.sources[0]), b(call.sources[1]), c(call.sources[2]) {}
  Reader<kNegates> a, b, c;
};

bool holds_special(const float* values, std::size_t count) {
  const auto* bits = reinterpret_cast<const std::uint32_t*>(values);
  for (std::size_t i = 0; i < count; i += hn::Lanes(U{}))
    if (any_special(hn::Load(U{}, bits + i))) return true;
  return false;
}

bool special_lanes(const Call& call, std::size_t i) {
  for (std::size_t k = 0; k < call.source_count; ++k)
    for (std::size_t c = 0; c < kComponents; ++c)
      if (any_special(Reader<false>(call.sources[k])(c, i))) return true;
  return false;
}

// Lets `compute(i)` store the results of the lanes from i. Where a source is special, or it says false, the
// scalar code does.
template <typename Compute>
HWY_INLINE void each_lanes(const Call& call, std::size_t count, Compute compute) {
  const bool doubtful = call.has_special_source();
  bool special = call.component_count != kComponents && *call.special;
  for (std::size_t i = 0; i < count; i += hn::Lanes(U{})) {
    if (HWY_UNLIKELY((doubtful && special_lanes(call, i)) || !compute(i))) {
      run_scalar(call, Arithmetic::nv20, static_cast<int>(i), static_cast<int>(i + hn::Lanes(U{})));
      special = true;
    }
  }
  *call.special = special;
}

HWY_INLINE void put(const Call& call, std::size_t k, std::size_t i, V result) {
  hn::Store(result, U{},
            reinterpret_cast<std::uint32_t*>(call.destination + call.components[k] * kBatch + i));
}

template <std::size_t kCount, typename Function>
HWY_INLINE void each_of(const Call& call, std::size_t count, Function function) {
  each_lanes(call, count, [&](std::size_t i) HWY_ATTR {
    V results[kCount], least = set(0xffffffffu);
    for (std::size_t k = 0; k < kCount; ++k) results[k] = function(call.components[k], i, least);
    if (HWY_UNLIKELY(!hn::AllFalse(U{}, hn::Lt(least, set(kSmallest - 1))))) return false;
    for (std::size_t k = 0; k < kCount; ++k) put(call, k, i, results[k]);
    return true;
  });
}

// The same scalar for every component.
template <typename Function>
HWY_INLINE void one_scalar(const Call& call, std::size_t count, Function function) {
  each_lanes(call, count, [&](std::size_t i) HWY_ATTR {
    V least = set(0xffffffffu);
    const V scalar = function(i, least);
    if (HWY_UNLIKELY(!hn::AllFalse(U{}, hn::Lt(least, set(kSmallest - 1))))) return false;
    for (std::size_t k = 0; k < call.component_count; ++k) put(call, k, i, scalar);
    return true;
  });
}

// result[k] = function(component k) for the components that are written.
template <typename Function>
HWY_INLINE void each_component(const Call& call, std::size_t count, Function function) {
  switch (call.component_count) {
    case 1:
      return one_scalar(call, count, [&](std::size_t i, V& least) HWY_ATTR {
        return function(call.components[0], i, least);
      });
    case 2:
      return each_of<2>(call, count, function);
    case 3:
      return each_of<3>(call, count, function);
    default:
      return each_of<4>(call, count, function);
  }
}

// result[k] = function(component k) of raw bits; it may be special where a source is.
template <typename Function>
HWY_INLINE void each_raw(const Call& call, std::size_t count, Function function) {
  const bool special = (call.component_count != kComponents && *call.special) || call.has_special_source();
  for (std::size_t i = 0; i < count; i += hn::Lanes(U{})) {
    V results[kComponents];
    for (std::size_t k = 0; k < call.component_count; ++k) results[k] = function(call.components[k], i);
    for (std::size_t k = 0; k < call.component_count; ++k) put(call, k, i, results[k]);
  }
  *call.special = special;
}

// A reciprocal of zero is an INF.
template <typename Function>
HWY_INLINE void one_reciprocal(const Call& call, std::size_t count, Function function) {
  bool special = false;
  one_scalar(call, count, [&](std::size_t i, V&) HWY_ATTR {
    const V result = function(i);
    special |= any_special(result);
    return result;
  });
  *call.special |= special;
}

template <std::size_t kTerms, bool kNegates>
HWY_INLINE V dot(const Sources<kNegates>& s, std::size_t i, V& least) {
  VF products[kTerms];
  for (std::size_t k = 0; k < kTerms; ++k) products[k] = hn::Mul(s.a.number(k, i), s.b.number(k, i));
  return sum(products, least);
}

template <bool kNegates>
void run_with_signs(const Call& call, int vertices) {
  const std::size_t lanes = hn::Lanes(U{});
  const std::size_t count = (static_cast<std::size_t>(vertices) + lanes - 1) / lanes * lanes;
  const Sources<kNegates> s(call);
  const V one = set(0x3f800000);
  using std::size_t;
  switch (call.operation) {
    case Operation::add:
      return each_component(call, count, [&](size_t k, size_t i, V& least) HWY_ATTR {
        return sum({s.a.number(k, i), s.b.number(k, i)}, least);
      });
    case Operation::multiply:
      return each_component(call, count,
                            [&](size_t k, size_t i, V&) HWY_ATTR { return multiply(s.a(k, i), s.b(k, i)); });
    case Operation::multiply_add:
      return each_component(call, count, [&](size_t k, size_t i, V& least) HWY_ATTR {
        return sum({hn::Mul(s.a.number(k, i), s.b.number(k, i)), s.c.number(k, i)}, least);
      });
    case Operation::dot3:
      return one_scalar(call, count, [&](size_t i, V& least) HWY_ATTR { return dot<3>(s, i, least); });
    case Operation::dot4:
      return one_scalar(call, count, [&](size_t i, V& least) HWY_ATTR { return dot<4>(s, i, least); });
    case Operation::minimum:
      return each_raw(call, count, [&](size_t k, size_t i) HWY_ATTR {
        const V a = s.a(k, i), b = s.b(k, i);
        return hn::IfThenElse(hn::Lt(order(a), order(b)), a, b);
      });
    case Operation::maximum:
      return each_raw(call, count, [&](size_t k, size_t i) HWY_ATTR {
        const V a = s.a(k, i), b = s.b(k, i);
        return hn::IfThenElse(hn::Lt(order(a), order(b)), b, a);
      });
    case Operation::less:
      return each_raw(call, count, [&](size_t k, size_t i) HWY_ATTR {
        return hn::IfThenElseZero(hn::Lt(order(s.a(k, i)), order(s.b(k, i))), one);
      });
    case Operation::greater_equal:
      return each_raw(call, count, [&](size_t k, size_t i) HWY_ATTR {
        return hn::IfThenZeroElse(hn::Lt(order(s.a(k, i)), order(s.b(k, i))), one);
      });
    case Operation::reciprocal:
      return one_reciprocal(call, count, [&](size_t i) HWY_ATTR { return reciprocal(s.a(0, i)); });
    case Operation::reciprocal_sqrt:
      return one_reciprocal(call, count, [&](size_t i) HWY_ATTR { return reciprocal_sqrt(s.a(0, i)); });
    case Operation::move:
      return each_raw(call, count, [&](size_t k, size_t i) HWY_ATTR { return s.a(k, i); });
    default:
      run_scalar(call, Arithmetic::nv20, 0, vertices);
      *call.special = true;  // it may be
  }
}

void run_nv20(const Call& call, int vertices) {
  const auto negates = [](const Operand& operand) { return operand.sign != 0; };
  if (std::ranges::any_of(std::span(call.sources).first(call.source_count), negates)) {
    run_with_signs<true>(call, vertices);
  } else {
    run_with_signs<false>(call, vertices);
  }
}

#endif
}  // namespace splatscope::vertex::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::vertex {
HWY_EXPORT(run_nv20);
HWY_EXPORT(holds_special);

bool holds_special(const float* values, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(holds_special)(values, count);
}

void run_simd_nv20(const Call& call, int count) {
  HWY_DYNAMIC_DISPATCH(run_nv20)(call, count);
}
}  // namespace splatscope::vertex
#endif
