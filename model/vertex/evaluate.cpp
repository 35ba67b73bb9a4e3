#include <bit>
#include <cmath>

#include "model/error.h"
#include "model/number/ieee.h"
#include "model/number/nv20.h"
#include "model/vertex/steps.h"

namespace splatscope::vertex {
namespace {

struct Ieee {
  using Value = float;
  using Vector = ieee::Vector;
  static constexpr auto add = ieee::add;
  static constexpr auto multiply = ieee::multiply;
  static constexpr auto multiply_add = ieee::multiply_add;
  static constexpr auto dot3 = ieee::dot3;
  static constexpr auto dot4 = ieee::dot4;
  static constexpr auto minimum = ieee::minimum;
  static constexpr auto maximum = ieee::maximum;
  static constexpr auto less = ieee::less;
  static constexpr auto greater_equal = ieee::greater_equal;
  static constexpr auto reciprocal = ieee::reciprocal;
  static constexpr auto reciprocal_sqrt = ieee::reciprocal_sqrt;
  static constexpr auto expp = ieee::expp;
  static constexpr auto logp = ieee::logp;
  static constexpr auto lit = ieee::lit;
  static constexpr auto distance = ieee::distance;
  static constexpr auto exponent = ieee::exp2;
  static constexpr auto logarithm = ieee::log2_magnitude;
  static constexpr auto fraction = ieee::fraction;
};

// Direct3D's ten-instruction expansions of exp and log are not published: their results are taken as exact,
// rounded to nearest, in the machine's range. frc is three instructions round expp's y.
struct Nv20 {
  using Value = nv20::Bits;
  using Vector = nv20::Vector;
  static constexpr auto add = nv20::add;
  static constexpr auto multiply = nv20::multiply;
  static constexpr auto multiply_add = nv20::multiply_add;
  static constexpr auto dot3 = nv20::dot3;
  static constexpr auto dot4 = nv20::dot4;
  static constexpr auto minimum = nv20::minimum;
  static constexpr auto maximum = nv20::maximum;
  static constexpr auto less = nv20::less;
  static constexpr auto greater_equal = nv20::greater_equal;
  static constexpr auto reciprocal = nv20::reciprocal;
  static constexpr auto reciprocal_sqrt = nv20::reciprocal_sqrt;
  static constexpr auto expp = nv20::expp;
  static constexpr auto logp = nv20::logp;
  static constexpr auto lit = nv20::lit;
  static constexpr auto distance = nv20::distance;
  static Value flushed(float value) {
    if (std::isnan(value)) return 0x7fffffffu;
    return std::bit_cast<Value>(std::fabs(value) < 0x1p-126f ? 0.0f : value);
  }
  static Value exponent(Value a) { return flushed(ieee::exp2(std::bit_cast<float>(a))); }
  static Value logarithm(Value a) {
    return flushed(ieee::log2_magnitude((a & 0x7f800000u) == 0 ? 0.0f : std::bit_cast<float>(a)));
  }
  static Value fraction(Value a) { return nv20::expp(a)[1]; }
};

template <typename A>
A::Vector evaluate_in(Operation operation, const std::array<typename A::Vector, 3>& sources) {
  using Vector = A::Vector;
  const Vector &a = sources[0], &b = sources[1], &c = sources[2];
  const auto each = [](auto&& component) {
    return Vector{component(std::size_t{0}), component(std::size_t{1}), component(std::size_t{2}),
                  component(std::size_t{3})};
  };
  const auto all = [](A::Value value) { return Vector{value, value, value, value}; };
  const auto pairs = [&](auto function) { return each([&](std::size_t i) { return function(a[i], b[i]); }); };
  switch (operation) {
    case Operation::move:
      return a;
    case Operation::add:
      return pairs(A::add);
    case Operation::multiply:
      return pairs(A::multiply);
    case Operation::multiply_add:
      return each([&](std::size_t i) { return A::multiply_add(a[i], b[i], c[i]); });
    case Operation::dot3:
      return all(A::dot3(a, b));
    case Operation::dot4:
      return all(A::dot4(a, b));
    case Operation::minimum:
      return pairs(A::minimum);
    case Operation::maximum:
      return pairs(A::maximum);
    case Operation::less:
      return pairs(A::less);
    case Operation::greater_equal:
      return pairs(A::greater_equal);
    case Operation::reciprocal:
      return all(A::reciprocal(a[0]));
    case Operation::reciprocal_sqrt:
      return all(A::reciprocal_sqrt(a[0]));
    case Operation::expp:
      return A::expp(a[0]);
    case Operation::logp:
      return A::logp(a[0]);
    case Operation::lit:
      return A::lit(a);
    case Operation::distance:
      return A::distance(a, b);
    case Operation::exponent:
      return all(A::exponent(a[0]));
    case Operation::logarithm:
      return all(A::logarithm(a[0]));
    case Operation::fraction:
      return each([&](std::size_t i) { return A::fraction(a[i]); });
    case Operation::load_address:
    case Operation::gather_constant:
    case Operation::spread:
      break;
  }
  throw ModelError("not an arithmetic operation");
}

}  // namespace

Vec4 evaluate(Operation operation, Arithmetic arithmetic, const std::array<Vec4, 3>& sources) {
  if (arithmetic == Arithmetic::ieee) return evaluate_in<Ieee>(operation, sources);
  return std::bit_cast<Vec4>(
      evaluate_in<Nv20>(operation, std::bit_cast<std::array<nv20::Vector, 3>>(sources)));
}

}  // namespace splatscope::vertex
