#pragma once

#include <array>
#include <cstdint>

// The vertex unit of the NV20 and NV25 (GeForce3, GeForce4 Ti), bit for bit, as the envytools project
// measured it on silicon (docs/nv20_arithmetic.md). Values are the raw bits of binary32. NaN results are
// 7fffffff; a value with exponent 0 is a zero for arithmetic.
namespace splatscope::nv20 {

using Bits = std::uint32_t;
using Vector = std::array<Bits, 4>;

// Truncated toward zero; a zero factor gives +0 whatever the other is; overflow gives the largest finite
// value.
Bits multiply(Bits a, Bits b);

// Sums of 2 to 4 terms with one common alignment: what is shifted out of a term is dropped before the sum.
Bits add(Bits a, Bits b);
inline Bits multiply_add(Bits a, Bits b, Bits c) {
  return add(multiply(a, b), c);
}
Bits dot3(const Vector& a, const Vector& b);
Bits dot4(const Vector& a, const Vector& b);

// By the total order of the raw bits: -NaN < -INF < ... < -0 < +0 < ... < +INF < +NaN.
Bits minimum(Bits a, Bits b);
Bits maximum(Bits a, Bits b);
Bits less(Bits a, Bits b);
Bits greater_equal(Bits a, Bits b);

Bits reciprocal(Bits a);
Bits reciprocal_sqrt(Bits a);  // of the magnitude

Vector expp(Bits a);
Vector logp(Bits a);  // of the magnitude
Vector lit(const Vector& a);
Vector distance(const Vector& a, const Vector& b);

// Seeds of the Newton steps of reciprocal (by the top 6 bits of the fraction) and reciprocal_sqrt (by the top
// 7 bits of the 24 bits of odd-exponent flag and fraction).
const std::array<std::uint32_t, 64>& reciprocal_seeds();
const std::array<std::uint32_t, 128>& reciprocal_sqrt_seeds();

}  // namespace splatscope::nv20
