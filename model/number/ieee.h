#pragma once

#include <array>

// The vertex unit's operations in IEEE-754 binary32, round to nearest, as Direct3D defines them: unfused
// multiply-add, dot products from the left, correctly rounded reciprocals. Functions are the reference that
// SIMD code must match in every bit. NaN results: the second operand's NaN if it is one, else the first's,
// quieted; else ffc00000.
namespace splatscope::ieee {

using Vector = std::array<float, 4>;

float add(float a, float b);
float multiply(float a, float b);
inline float multiply_add(float a, float b, float c) {
  return add(multiply(a, b), c);
}
float dot3(const Vector& a, const Vector& b);
float dot4(const Vector& a, const Vector& b);

inline float minimum(float a, float b) {
  return a < b ? a : b;
}
inline float maximum(float a, float b) {
  return a >= b ? a : b;
}
inline float less(float a, float b) {
  return a < b ? 1.0f : 0.0f;
}
inline float greater_equal(float a, float b) {
  return a >= b ? 1.0f : 0.0f;
}

float reciprocal(float a);
float reciprocal_sqrt(float a);  // of the magnitude; +INF of a zero

float exp2(float a);            // `exp`
float log2_magnitude(float a);  // `log`; -INF of a zero
float fraction(float a);        // `frc`: a - floor(a)

Vector expp(float a);  // 2^floor(a), a - floor(a), 2^a, 1
Vector logp(float a);  // exponent and mantissa of |a|, log2 |a|, 1
// 1, max(x, 0), y^w where x and y are positive (w clamped to +-127.9961, else 0), 1.
Vector lit(const Vector& a);
Vector distance(const Vector& a, const Vector& b);  // `dst`: 1, a.y*b.y, a.z, b.w

}  // namespace splatscope::ieee
