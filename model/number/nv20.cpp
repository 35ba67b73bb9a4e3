#include "model/number/nv20.h"

#include <algorithm>
#include <bit>
#include <span>

namespace splatscope::nv20 {
namespace {

constexpr Bits kNan = 0x7fffffffu;
constexpr Bits kInfinity = 0x7f800000u;
constexpr Bits kLargest = 0x7f7fffffu;
constexpr Bits kOne = 0x3f800000u;
constexpr Bits kSign = 0x80000000u;
constexpr Bits kImplicit = 1u << 23;
constexpr Bits kFraction = kImplicit - 1;
constexpr int kBias = 127;

// Look-up tables of the scalar functions, as measured (tests/oracle/nv20_tables.json).
constexpr std::array<std::uint32_t, 32> kExp2Base = {
    0,    359,  725,  1100, 1483, 1874, 2274,  2683,  3100,  3527,  3963,  4408,  4863,  5329,  5804,  6290,
    6787, 7294, 7812, 8342, 8884, 9437, 10002, 10580, 11171, 11774, 12391, 13020, 13665, 14322, 14995, 15684};

constexpr std::array<std::uint32_t, 32> kExp2Slope = {359, 366, 375, 383, 391, 400, 409, 417, 427, 436, 445,
                                                      455, 466, 475, 486, 497, 507, 518, 530, 542, 553, 565,
                                                      578, 591, 603, 617, 629, 645, 657, 673, 689, 699};

constexpr std::array<std::uint32_t, 32> kLog2Base = {
    0,      11702,  22973,  33939,  44589,  54950,  65056,  74856,  84430,  93767,  102879,
    111777, 120470, 128969, 137279, 145412, 153374, 161170, 168811, 176299, 183642, 190844,
    197914, 204853, 211667, 218359, 224937, 231401, 237757, 244008, 250155, 256213};

constexpr std::array<std::uint32_t, 32> kLog2Slope = {
    11702, 11271, 10966, 10650, 10361, 10106, 9800, 9574, 9337, 9112, 8898, 8693, 8499, 8310, 8133, 7962,
    7796,  7641,  7488,  7343,  7202,  7070,  6939, 6814, 6692, 6578, 6464, 6356, 6251, 6147, 6058, 5930};

constexpr std::array<std::uint32_t, 64> kReciprocalSeeds = {
    127, 125, 123, 121, 120, 118, 116, 115, 113, 111, 110, 109, 107, 106, 104, 103, 102, 101, 99, 98, 97, 96,
    95,  94,  93,  92,  91,  90,  89,  88,  87,  86,  85,  84,  83,  82,  82,  81,  80,  79,  78, 78, 77, 76,
    76,  75,  74,  73,  73,  72,  72,  71,  70,  70,  69,  69,  68,  67,  67,  66,  66,  65,  65, 64};

constexpr std::array<std::uint32_t, 128> kReciprocalSqrtSeeds = {
    127, 127, 126, 125, 124, 123, 122, 121, 120, 119, 119, 118, 117, 116, 116, 115, 114, 113, 113,
    112, 111, 111, 110, 109, 109, 108, 108, 107, 106, 106, 105, 105, 104, 104, 103, 103, 102, 102,
    101, 101, 100, 100, 99,  99,  98,  98,  97,  97,  97,  96,  96,  95,  95,  94,  94,  94,  93,
    93,  93,  92,  92,  91,  91,  91,  90,  89,  89,  88,  87,  87,  86,  86,  85,  84,  84,  83,
    83,  82,  82,  81,  81,  80,  80,  79,  79,  78,  78,  77,  77,  77,  76,  76,  75,  75,  74,
    74,  74,  73,  73,  73,  72,  72,  72,  71,  71,  70,  70,  70,  70,  69,  69,  69,  68,  68,
    68,  67,  67,  67,  67,  66,  66,  66,  65,  65,  65,  65,  64,  64};

constexpr Bits sign_of(Bits a) {
  return a & kSign;
}
constexpr int exponent_of(Bits a) {
  return static_cast<int>(a >> 23 & 0xff);
}
constexpr Bits fraction_of(Bits a) {
  return a & kFraction;
}
constexpr bool is_zero(Bits a) {
  return exponent_of(a) == 0;
}
constexpr bool is_nan(Bits a) {
  return exponent_of(a) == 255 && fraction_of(a) != 0;
}
constexpr bool is_infinite(Bits a) {
  return (a & ~kSign) == kInfinity;
}

// A finite result whose significand has its top bit at 23: no rounding is left, only the range.
Bits pack(Bits sign, int exponent, Bits significand) {
  if (exponent >= 255) return sign | kLargest;
  if (exponent <= 0) return sign;
  return sign | static_cast<Bits>(exponent) << 23 | (significand & kFraction);
}

Bits sum(std::span<const Bits> terms) {
  if (std::ranges::any_of(terms, is_nan)) return kNan;
  const auto has = [&](Bits value) { return std::ranges::find(terms, value) != terms.end(); };
  if (has(kInfinity)) return has(kInfinity | kSign) ? kNan : kInfinity;
  if (has(kInfinity | kSign)) return kInfinity | kSign;
  int largest = 0;
  for (const Bits term : terms) largest = std::max(largest, exponent_of(term));
  std::int32_t total = 0;
  for (const Bits term : terms) {
    const int exponent = exponent_of(term);
    const Bits significand = fraction_of(term) | (exponent != 0 ? kImplicit : 0u);
    const auto aligned = static_cast<std::int32_t>((significand << 5) >> std::min(largest - exponent, 31));
    total += sign_of(term) ? -aligned : aligned;
  }
  if (total == 0) return 0;
  const Bits magnitude = total < 0 ? -static_cast<Bits>(total) : static_cast<Bits>(total);
  const int shift = std::countl_zero(magnitude) - 1;  // to bit 30
  return pack(total < 0 ? kSign : 0u, largest + 2 - shift, magnitude << shift >> 7);
}

// Order of the raw bits as an unsigned number.
constexpr Bits order(Bits a) {
  return a & kSign ? ~a : a | kSign;
}

// The argument of 2^x with 13 fraction bits, rounded down; saturated from 2^18 on, 0 under 2^-23.
std::int32_t fixed_point(Bits a) {
  const int exponent = exponent_of(a) - kBias;
  const bool negative = sign_of(a) != 0;
  if (is_nan(a)) return INT32_MAX;
  if (exponent >= 18) return negative ? INT32_MIN : INT32_MAX;
  if (exponent < -23) return 0;
  const std::int64_t significand = fraction_of(a) | kImplicit;
  const std::int64_t scaled = (negative ? -significand : significand) << 18;  // 2^18: room for every exponent
  return static_cast<std::int32_t>(scaled >> (18 + 10 - exponent));
}

Bits exp2_of_fixed(std::int32_t x) {
  const std::int32_t whole = x >> 13;
  if (whole <= -kBias) return 0;
  if (whole >= 128) return kInfinity;
  const auto high = static_cast<std::size_t>(x >> 8 & 0x1f);
  const auto low = static_cast<Bits>(x & 0xff);
  return (static_cast<Bits>(whole + kBias) << 23) + 2 * (256 * kExp2Base[high] + kExp2Slope[high] * low);
}

// a - floor(a): a itself in [0, 1), else in steps of 2^-23, rounded down; 1 just below zero.
Bits fractional_part(Bits a) {
  if (is_nan(a)) return a;
  const int exponent = exponent_of(a) - kBias;
  if (is_zero(a) || exponent >= 23) return 0;
  if (!sign_of(a) && exponent < 0) return a;
  if (exponent < -23) return kOne;
  const std::int64_t significand = fraction_of(a) | kImplicit;
  const std::int64_t steps =
      exponent >= 0 ? significand << exponent : -((significand + (1 << -exponent) - 1) >> -exponent);
  const Bits part = static_cast<Bits>(exponent >= 0 && sign_of(a) ? -steps : steps) & kFraction;
  if (part == 0) return 0;
  const int shift = std::countl_zero(part) - 8;  // to bit 23
  return pack(0, kBias - shift, part << shift);
}

// log2 of a positive finite value, with 26 fraction bits.
std::int64_t log2_fixed(Bits a) {
  const std::size_t high = a >> 18 & 0x1f;
  const Bits low = a >> 10 & 0xff;
  const std::int64_t fraction = 256 * kLog2Base[high] + kLog2Slope[high] * low;
  return fraction + (static_cast<std::int64_t>(exponent_of(a)) - kBias) * (std::int64_t{1} << 26);
}

// value * 2^-scale, truncated.
Bits float_of(std::int64_t value, int scale) {
  if (value == 0) return 0;
  const auto magnitude = static_cast<std::uint64_t>(value < 0 ? -value : value);
  const int top = 63 - std::countl_zero(magnitude);
  const auto significand = static_cast<Bits>(top >= 23 ? magnitude >> (top - 23) : magnitude << (23 - top));
  return pack(value < 0 ? kSign : 0u, kBias + top - scale, significand);
}

// The power of lit: y^w for positive x; zeros, signs and INF of y and w first.
Bits power(Bits y, Bits w) {
  if (is_zero(w)) return kOne;
  if (is_nan(y) || is_nan(w)) return kNan;
  if (sign_of(y) || is_zero(y)) return sign_of(w) ? kInfinity : 0u;
  if (is_infinite(y)) return sign_of(w) ? 0u : kInfinity;
  const std::int64_t exponent = std::clamp(fixed_point(w), -0x100000, 0xfffff);
  const std::int64_t product = log2_fixed(y) * exponent >> 26;
  if (product < INT32_MIN) return 0;
  if (product > INT32_MAX) return kInfinity;
  return exp2_of_fixed(static_cast<std::int32_t>(product));
}

}  // namespace

Bits multiply(Bits a, Bits b) {
  if (is_zero(a) || is_zero(b)) return 0;
  if (is_nan(a) || is_nan(b)) return kNan;
  const Bits sign = sign_of(a ^ b);
  if (is_infinite(a) || is_infinite(b)) return sign | kInfinity;
  const std::uint64_t product = std::uint64_t{fraction_of(a) | kImplicit} * (fraction_of(b) | kImplicit);
  const int carry = static_cast<int>(product >> 47);
  return pack(sign, exponent_of(a) + exponent_of(b) - kBias + carry,
              static_cast<Bits>(product >> (23 + carry)));
}

Bits add(Bits a, Bits b) {
  return sum(std::array{a, b});
}

Bits dot3(const Vector& a, const Vector& b) {
  return sum(std::array{multiply(a[0], b[0]), multiply(a[1], b[1]), multiply(a[2], b[2])});
}

Bits dot4(const Vector& a, const Vector& b) {
  return sum(
      std::array{multiply(a[0], b[0]), multiply(a[1], b[1]), multiply(a[2], b[2]), multiply(a[3], b[3])});
}

Bits minimum(Bits a, Bits b) {
  return order(a) < order(b) ? a : b;
}
Bits maximum(Bits a, Bits b) {
  return order(a) < order(b) ? b : a;
}
Bits less(Bits a, Bits b) {
  return order(a) < order(b) ? kOne : 0u;
}
Bits greater_equal(Bits a, Bits b) {
  return order(a) < order(b) ? 0u : kOne;
}

// Two Newton steps in integers.
Bits reciprocal(Bits a) {
  if (is_nan(a)) return kNan;
  if (is_zero(a)) return sign_of(a) | kInfinity;
  const int exponent = 0xfe - exponent_of(a);
  if (fraction_of(a) == 0) return pack(sign_of(a), exponent, kImplicit);
  const std::uint64_t significand = fraction_of(a) | kImplicit;
  const std::uint64_t s0 = kReciprocalSeeds[fraction_of(a) >> 17];
  const std::uint64_t s1 = ((std::uint64_t{1} << 31) - s0 * significand) * s0 >> 24;
  const std::uint64_t s2 = ((std::uint64_t{1} << 37) - s1 * significand) * s1 >> 25;
  return pack(sign_of(a), exponent - 1, static_cast<Bits>(s2));
}

Bits reciprocal_sqrt(Bits a) {
  if (is_nan(a)) return kNan;
  if (is_zero(a)) return kInfinity;
  if (is_infinite(a)) return 0;
  // An even biased exponent is an odd power of two: its factor of 2 goes into the significand.
  const bool odd_power = exponent_of(a) % 2 == 0;
  const std::size_t index = (fraction_of(a) | (odd_power ? kImplicit : 0u)) >> 17;
  const std::uint64_t significand = std::uint64_t{fraction_of(a) | kImplicit} << (odd_power ? 1 : 0);
  const std::uint64_t s0 = kReciprocalSqrtSeeds[index];
  const std::uint64_t s1 = ((std::uint64_t{3} << 37) - s0 * s0 * significand) * s0 >> 32;
  const std::uint64_t s2 = ((std::uint64_t{3} << 49) - s1 * s1 * significand) * s1 >> 39;
  return pack(0, kBias - (exponent_of(a) - kBias - (odd_power ? 1 : 0)) / 2 - 1, static_cast<Bits>(s2));
}

Vector expp(Bits a) {
  const std::int32_t x = fixed_point(a);
  return {exp2_of_fixed(x & ~0x1fff), fractional_part(a), is_nan(a) ? kNan : exp2_of_fixed(x), kOne};
}

Vector logp(Bits a) {
  const Bits magnitude = a & ~kSign;
  if (is_nan(a)) return {magnitude, magnitude, magnitude, kOne};
  if (is_zero(a)) return {kInfinity | kSign, kOne, kInfinity | kSign, kOne};
  if (is_infinite(a)) return {kInfinity, kOne, kInfinity, kOne};
  return {float_of(exponent_of(a) - kBias, 0), kOne | fraction_of(a), float_of(log2_fixed(magnitude), 26),
          kOne};
}

Vector lit(const Vector& a) {
  if (sign_of(a[0])) return {kOne, 0, 0, kOne};
  return {kOne, a[0], is_zero(a[0]) ? 0u : power(a[1], a[3]), kOne};
}

Vector distance(const Vector& a, const Vector& b) {
  return {kOne, multiply(a[1], b[1]), a[2], b[3]};
}

const std::array<std::uint32_t, 64>& reciprocal_seeds() {
  return kReciprocalSeeds;
}
const std::array<std::uint32_t, 128>& reciprocal_sqrt_seeds() {
  return kReciprocalSqrtSeeds;
}

}  // namespace splatscope::nv20
