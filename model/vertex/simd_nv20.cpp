// The NV20's arithmetic on SIMD registers of integers, compiled once a target and chosen at run time
// (Highway). Bit for bit that of model/number/nv20.h; lanes with an INF or NaN operand go through run_scalar.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/vertex/simd_nv20.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "model/number/nv20.h"
#include "model/vertex/steps.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::vertex::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR

void run_nv20(const Call& call, int vertices) {
  run_scalar(call, Arithmetic::nv20, 0, vertices);
}

#else
namespace hn = hwy::HWY_NAMESPACE;

using U = hn::CappedTag<std::uint32_t, kBroadcast>;
using I = hn::RebindToSigned<U>;
using F = hn::RebindToFloat<U>;
using W = hn::Repartition<std::uint64_t, U>;  // pairs of lanes
using V = hn::Vec<U>;
using VI = hn::Vec<I>;
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

HWY_INLINE V multiply(V a, V b) {
  const V exponent_a = exponent_of(a), exponent_b = exponent_of(b);
  const V implicit = set(0x80000000u);
  // Significands at bit 31: the high half of their product is the 48-bit one without its 16 low bits.
  const V product =
      high_product(hn::Or(hn::ShiftLeft<8>(a), implicit), hn::Or(hn::ShiftLeft<8>(b), implicit));
  const V carry = hn::ShiftRight<31>(product);
  const V significand =
      hn::ShiftRight<7>(hn::IfThenElse(hn::Eq(carry, hn::Zero(U{})), product, hn::ShiftRight<1>(product)));
  const VI exponent = as_signed(hn::Sub(hn::Add(hn::Add(exponent_a, exponent_b), carry), set(127)));
  const auto zero = hn::Or(hn::Eq(exponent_a, hn::Zero(U{})), hn::Eq(exponent_b, hn::Zero(U{})));
  return hn::IfThenZeroElse(zero, pack(sign_of(hn::Xor(a, b)), exponent, significand));
}

template <std::size_t kTerms>
HWY_INLINE V sum(const V (&terms)[kTerms]) {
  V largest = exponent_of(terms[0]);
  for (std::size_t k = 1; k < kTerms; ++k) largest = hn::Max(largest, exponent_of(terms[k]));
  V total = hn::Zero(U{});
  for (std::size_t k = 0; k < kTerms; ++k) {
    const V exponent = exponent_of(terms[k]);
    const V implicit = hn::IfThenZeroElse(hn::Eq(exponent, hn::Zero(U{})), set(1u << 23));
    const V significand = hn::ShiftLeft<5>(hn::Or(fraction_of(terms[k]), implicit));
    const V aligned = hn::Shr(significand, hn::Min(hn::Sub(largest, exponent), set(31)));
    const V negative = as_unsigned(hn::ShiftRight<31>(as_signed(terms[k])));
    total = hn::Add(total, hn::Sub(hn::Xor(aligned, negative), negative));
  }
  const V negative = as_unsigned(hn::ShiftRight<31>(as_signed(total)));
  const V magnitude = hn::Sub(hn::Xor(total, negative), negative);
  // The top bit's place by a conversion to float, of a number that rounding cannot carry to the next power of
  // two.
  const VI no_carry = as_signed(hn::AndNot(hn::ShiftRight<1>(magnitude), magnitude));
  const V top = hn::Sub(exponent_of(hn::BitCast(U{}, hn::ConvertTo(F{}, no_carry))), set(127));
  const V shift = hn::And(hn::Sub(set(30), top), set(31));
  const V significand = hn::ShiftRight<7>(hn::Shl(magnitude, shift));
  const V result = pack(sign_of(negative), as_signed(hn::Sub(hn::Add(largest, set(2)), shift)), significand);
  return hn::IfThenZeroElse(hn::Eq(total, hn::Zero(U{})), result);
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

// Reads of one operand for the vertices from `i`; remembers whether a lane was INF or NaN.
struct Reader {
  explicit Reader(const Operand& operand) : operand(operand), sign(set(operand.sign)) {}
  V operator()(std::size_t component, std::size_t i) {
    const V value = raw(component, i);
    special = hn::Or(
        special, as_unsigned(hn::VecFromMask(I{}, hn::Gt(as_signed(exponent_of(value)), hn::Set(I{}, 254)))));
    return value;
  }
  V raw(std::size_t component, std::size_t i) const {
    const auto* bits =
        reinterpret_cast<const std::uint32_t*>(operand.component[component] + i * operand.stride);
    return hn::Xor(hn::Load(U{}, bits), sign);
  }
  const Operand& operand;
  V sign;
  V special = hn::Zero(U{});
};

struct Sources {
  explicit Sources(const Call& call) : a(call.sources[0]), b(call.sources[1]), c(call.sources[2]) {}
  bool special() const {
    const V any = hn::Or(a.special, hn::Or(b.special, c.special));
    return !hn::AllTrue(U{}, hn::Eq(any, hn::Zero(U{})));
  }
  void forget_special() { a.special = b.special = c.special = hn::Zero(U{}); }
  Reader a, b, c;
};

HWY_INLINE void store(const Call& call, std::size_t i, const V* results, Sources& sources) {
  if (HWY_UNLIKELY(sources.special())) {
    run_scalar(call, Arithmetic::nv20, static_cast<int>(i), static_cast<int>(i + hn::Lanes(U{})));
    sources.forget_special();
    return;
  }
  for (std::size_t k = 0; k < kComponents; ++k)
    if (call.mask & (1u << k))
      hn::Store(results[k], U{}, reinterpret_cast<std::uint32_t*>(call.destination + k * kBatch + i));
}

// result[k] = function(component k) for the components of the mask.
template <typename Function>
HWY_INLINE void each_component(const Call& call, std::size_t count, Sources& sources, Function function) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(U{})) {
    V results[kComponents] = {hn::Zero(U{}), hn::Zero(U{}), hn::Zero(U{}), hn::Zero(U{})};
    for (std::size_t k = 0; k < kComponents; ++k)
      if (call.mask & (1u << k)) results[k] = function(k, i);
    store(call, i, results, sources);
  }
}

// The same scalar for every component.
template <typename Function>
HWY_INLINE void one_scalar(const Call& call, std::size_t count, Sources& sources, Function function) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(U{})) {
    const V scalar = function(i);
    const V results[kComponents] = {scalar, scalar, scalar, scalar};
    store(call, i, results, sources);
  }
}

template <std::size_t kTerms>
HWY_INLINE V dot(Sources& s, std::size_t i) {
  V products[kTerms];
  for (std::size_t k = 0; k < kTerms; ++k) products[k] = multiply(s.a(k, i), s.b(k, i));
  return sum(products);
}

void run_nv20(const Call& call, int vertices) {
  const std::size_t lanes = hn::Lanes(U{});
  const std::size_t count = (static_cast<std::size_t>(vertices) + lanes - 1) / lanes * lanes;
  Sources s(call);
  const V one = set(0x3f800000);
  using std::size_t;
  switch (call.operation) {
    case Operation::add:
      return each_component(call, count, s, [&](size_t k, size_t i) HWY_ATTR {
        return sum({s.a(k, i), s.b(k, i)});
      });
    case Operation::multiply:
      return each_component(call, count, s,
                            [&](size_t k, size_t i) HWY_ATTR { return multiply(s.a(k, i), s.b(k, i)); });
    case Operation::multiply_add:
      return each_component(call, count, s, [&](size_t k, size_t i) HWY_ATTR {
        return sum({multiply(s.a(k, i), s.b(k, i)), s.c(k, i)});
      });
    case Operation::dot3:
      return one_scalar(call, count, s, [&](size_t i) HWY_ATTR { return dot<3>(s, i); });
    case Operation::dot4:
      return one_scalar(call, count, s, [&](size_t i) HWY_ATTR { return dot<4>(s, i); });
    case Operation::minimum:
      return each_component(call, count, s, [&](size_t k, size_t i) HWY_ATTR {
        const V a = s.a.raw(k, i), b = s.b.raw(k, i);
        return hn::IfThenElse(hn::Lt(order(a), order(b)), a, b);
      });
    case Operation::maximum:
      return each_component(call, count, s, [&](size_t k, size_t i) HWY_ATTR {
        const V a = s.a.raw(k, i), b = s.b.raw(k, i);
        return hn::IfThenElse(hn::Lt(order(a), order(b)), b, a);
      });
    case Operation::less:
      return each_component(call, count, s, [&](size_t k, size_t i) HWY_ATTR {
        return hn::IfThenElseZero(hn::Lt(order(s.a.raw(k, i)), order(s.b.raw(k, i))), one);
      });
    case Operation::greater_equal:
      return each_component(call, count, s, [&](size_t k, size_t i) HWY_ATTR {
        return hn::IfThenZeroElse(hn::Lt(order(s.a.raw(k, i)), order(s.b.raw(k, i))), one);
      });
    case Operation::reciprocal:
      return one_scalar(call, count, s, [&](size_t i) HWY_ATTR { return reciprocal(s.a(0, i)); });
    case Operation::reciprocal_sqrt:
      return one_scalar(call, count, s, [&](size_t i) HWY_ATTR { return reciprocal_sqrt(s.a(0, i)); });
    case Operation::move:
      return run_simd_ieee(call, vertices);  // raw bits in either arithmetic
    default:
      return run_scalar(call, Arithmetic::nv20, 0, vertices);
  }
}

#endif
}  // namespace splatscope::vertex::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::vertex {
HWY_EXPORT(run_nv20);

void run_simd_nv20(const Call& call, int count) {
  HWY_DYNAMIC_DISPATCH(run_nv20)(call, count);
}
}  // namespace splatscope::vertex
#endif
