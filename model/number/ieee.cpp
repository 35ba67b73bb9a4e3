#include "model/number/ieee.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace splatscope::ieee {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float from_bits(std::uint32_t bits) {
  return std::bit_cast<float>(bits);
}
float quiet(float nan) {
  return from_bits(std::bit_cast<std::uint32_t>(nan) | 0x00400000u);
}

float nan_of(float first, float second) {
  if (std::isnan(second)) return quiet(second);
  if (std::isnan(first)) return quiet(first);
  return from_bits(0xffc00000u);
}

}  // namespace

float add(float a, float b) {
  const float sum = a + b;
  return std::isnan(sum) ? nan_of(a, b) : sum;
}

float multiply(float a, float b) {
  const float product = a * b;
  return std::isnan(product) ? nan_of(a, b) : product;
}

float dot3(const Vector& a, const Vector& b) {
  return add(add(multiply(a[0], b[0]), multiply(a[1], b[1])), multiply(a[2], b[2]));
}

float dot4(const Vector& a, const Vector& b) {
  return add(dot3(a, b), multiply(a[3], b[3]));
}

float reciprocal(float a) {
  return std::isnan(a) ? quiet(a) : 1.0f / a;
}

float reciprocal_sqrt(float a) {
  const float magnitude = std::fabs(a);
  // Rounded once from double: exact to the last bit of a float.
  return std::isnan(a) ? quiet(magnitude)
                       : static_cast<float>(1.0 / std::sqrt(static_cast<double>(magnitude)));
}

float exp2(float a) {
  return std::isnan(a) ? quiet(a) : static_cast<float>(std::exp2(static_cast<double>(a)));
}

float log2_magnitude(float a) {
  if (std::isnan(a)) return from_bits(0x7fffffffu);
  return static_cast<float>(std::log2(std::fabs(static_cast<double>(a))));
}

float fraction(float a) {
  return std::isnan(a) ? quiet(a) : add(a, -std::floor(a));
}

Vector expp(float a) {
  if (std::isnan(a)) return {quiet(a), quiet(a), quiet(a), 1.0f};
  return {exp2(std::floor(a)), fraction(a), exp2(a), 1.0f};
}

Vector logp(float a) {
  if (std::isnan(a)) return {from_bits(0x7fffffffu), from_bits(0x7fffffffu), from_bits(0x7fffffffu), 1.0f};
  const float magnitude = std::fabs(a);
  if (magnitude == 0.0f) return {-kInfinity, 1.0f, -kInfinity, 1.0f};
  if (std::isinf(magnitude)) return {kInfinity, 1.0f, kInfinity, 1.0f};
  int exponent = 0;
  const float mantissa = 2.0f * std::frexp(magnitude, &exponent);
  return {static_cast<float>(exponent - 1), mantissa, log2_magnitude(a), 1.0f};
}

Vector lit(const Vector& a) {
  Vector result{1.0f, 0.0f, 0.0f, 1.0f};
  if (!(a[0] > 0.0f)) return result;
  result[1] = a[0];
  if (!(a[1] > 0.0f)) return result;
  const double power =
      std::isnan(a[3]) ? static_cast<double>(quiet(a[3])) : std::clamp<double>(a[3], -127.9961, 127.9961);
  result[2] = static_cast<float>(std::pow(static_cast<double>(a[1]), power));
  return result;
}

Vector distance(const Vector& a, const Vector& b) {
  return {1.0f, multiply(a[1], b[1]), a[2], b[3]};
}

}  // namespace splatscope::ieee
