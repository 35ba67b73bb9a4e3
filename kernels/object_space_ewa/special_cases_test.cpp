#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "kernels/object_space_ewa/quad_runner.h"
#include "kernels/object_space_ewa/splat_accuracy.h"

// Where the formulas of the paper break or their guards act: t = 0, p = 0 with B < 0, D = 0, behind the eye,
// and finite numbers that no scene has.
namespace splatscope::kernels {
namespace {

// Camera space is object space, and numbers are exact.
View exact_view() {
  View view;
  view.width = view.height = 512;
  view.eta = 512.0;
  view.near_plane = 0.125;
  view.far_plane = 1000.0;
  return view;
}

Surfel surfel_at(const glm::dvec3& o, const glm::dvec3& s, const glm::dvec3& t) {
  Surfel surfel;
  surfel.position = o;
  surfel.tangent_s = s;
  surfel.tangent_t = t;
  return surfel;
}

// With s and t exchanged where s x t points away from the eye, at the origin.
Surfel facing_eye(Surfel surfel) {
  if (glm::dot(glm::cross(surfel.tangent_s, surfel.tangent_t), surfel.position) > 0) {
    std::swap(surfel.tangent_s, surfel.tangent_t);
  }
  return surfel;
}

QuadOutput run_one(const SplatProgram& program, const View& view, const Surfel& surfel) {
  return run_quads(program, Arithmetic::ieee, view, 0.0, std::vector<Surfel>{surfel})[0];
}

glm::dmat2 axes_of(const View& view, const Surfel& surfel, const QuadOutput& quad) {
  return measured_axes(tangent_plane(view, surfel, quad), gaussian_coordinates(quad));
}

class SpecialCases : public testing::TestWithParam<SplatProgram> {};
INSTANTIATE_TEST_SUITE_P(Programs, SpecialCases, testing::ValuesIn(ewa_programs()), program_name);

// Appendix A, as printed (`printed_sign`) or with Sgn(B) Sgn(p) for Sgn(Bp).
glm::dmat2 appendix_a(const glm::dmat2& m, bool printed_sign) {
  const auto sign = [](double x) { return x < 0 ? -1.0 : 1.0; };
  const double b = 2.0 * m[0][1];
  const double p = m[0][0] - m[1][1];
  const double q = m[0][0] + m[1][1];
  const double t = sign(p) * std::sqrt(p * p + b * b);
  const double cosine = std::sqrt((t + p) / (2 * t));
  const double sine = (printed_sign ? sign(b * p) : sign(b) * sign(p)) * std::sqrt((t - p) / (2 * t));
  const glm::dmat2 rotation{{cosine, sine}, {-sine, cosine}};
  return rotation * glm::dmat2{{(q + t) / 2, 0}, {0, (q - t) / 2}} * glm::transpose(rotation);
}

void expect_near(const glm::dmat2& a, const glm::dmat2& b, double tolerance) {
  for (int column = 0; column < 2; ++column) {
    for (int row = 0; row < 2; ++row) EXPECT_NEAR(a[column][row], b[column][row], tolerance);
  }
}

TEST(AppendixA, PrintedSignIsWrongWherePIs0AndBNegative) {
  for (const double b : {-1.0, 1.0}) {
    for (const double p : {-0.5, 0.0, 0.5}) {
      const glm::dmat2 m{{2.0 + p, 0.5 * b}, {0.5 * b, 2.0}};
      expect_near(appendix_a(m, false), m, 1e-12);
      if (p != 0 || b > 0) expect_near(appendix_a(m, true), m, 1e-12);
    }
  }
  // The mirror image of the ellipse.
  expect_near(appendix_a({{2.0, -0.5}, {-0.5, 2.0}}, true), {{2.0, 0.5}, {0.5, 2.0}}, 1e-12);
}

// The plane is tilted about a diagonal of s and t, so S = T exactly; the sign of B by the direction of the
// tilt.
TEST_P(SpecialCases, PIs0) {
  const View view = exact_view();
  const double tilt = std::sqrt(0.375);
  for (const double direction : {-1.0, 1.0}) {
    const Surfel surfel = surfel_at({0, 0, 2}, 0.01 * glm::dvec3(0.75, 0.25, tilt),
                                    direction * 0.01 * glm::dvec3(0.25, 0.75, -tilt));
    const SurfelFilter filter = *surfel_filter(view, surfel, true);
    ASSERT_NEAR(filter.variance[0][0] - filter.variance[1][1], 0.0, 1e-12);
    ASSERT_LT(direction * filter.variance[0][1], -0.01);
    const Surfel facing = facing_eye(surfel);
    const glm::dmat2 axes = axes_of(view, surfel, run_one(GetParam(), view, facing));
    expect_near(axes * glm::transpose(axes), filter.variance, 1e-4);
  }
}

// Every surfel of a plane that faces the camera, wherever it is: J is a multiple of I.
TEST_P(SpecialCases, TIs0) {
  const View view = exact_view();
  for (const double x : {-0.5, 0.0, 0.3}) {
    for (const double y : {-0.4, 0.0, 0.6}) {
      const Surfel surfel = facing_eye(surfel_at({x, y, 2}, {0.01, 0, 0}, {0, 0.01, 0}));
      const QuadOutput quad = run_one(GetParam(), view, surfel);
      ASSERT_TRUE(is_finite(quad));
      const glm::dmat2 axes = axes_of(view, surfel, quad);
      const double variance = 1.0 + 1.0 / (2.56 * 2.56);  // h is 2.56 pixels
      expect_near(axes * glm::transpose(axes), glm::dmat2(variance), 1e-5);
    }
  }
}

// The eye is in the plane of the surfel: nothing is to be seen of it.
TEST_P(SpecialCases, DIs0) {
  const View view = exact_view();
  for (const glm::dvec3 across :
       {glm::dvec3(0.01, 0, 0), glm::dvec3(0, 0.01, 0), glm::dvec3(0.006, 0.008, 0)}) {
    for (const double along : {-0.01, 0.01}) {
      const QuadOutput quad = run_one(GetParam(), view, surfel_at({0, 0, 2}, across, {0, 0, along}));
      ASSERT_TRUE(is_finite(quad));
      EXPECT_LT(quad[0].diffuse.w, 1e-4);
    }
  }
}

// The paper's program: infinitely long along the ray, one pixel's filter and its own across; as much of that
// is drawn as stays half the depth away from the eye.
TEST(SpecialCasesOfThePaper, DIs0) {
  const View view = exact_view();
  for (const bool swapped : {false, true}) {
    Surfel surfel = surfel_at({0, 0, 2}, {0.01, 0, 0}, {0, 0, 0.01});
    if (swapped) std::swap(surfel.tangent_s, surfel.tangent_t);
    const QuadOutput quad = run_one(ewa_program("paper"), view, surfel);
    const auto corner = [&](std::size_t i) {
      return glm::dvec2(quad[i].position.x * 0.5 * view.width / view.eta, quad[i].position.w);  // x, z
    };
    const auto y = gaussian_coordinates(quad);
    const double side = y[1].x - y[0].x;
    const std::size_t across = swapped ? 3 : 1, along = swapped ? 1 : 3;  // corners beside the first
    EXPECT_NEAR(std::abs(corner(across).x - corner(0).x) / side, 0.01 * std::sqrt(1.0 + 1.0 / (2.56 * 2.56)),
                1e-5);
    EXPECT_GT(std::abs(corner(along).y - corner(0).y) / side, 100.0);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_GT(corner(i).y, 1.0);
  }
}

// Each guard of the program, switched off by its constant.
TEST(SpecialCasesOfThePaper, GuardsAct) {
  const View view = exact_view();
  const SplatProgram& program = ewa_program("paper");
  const std::vector<Vec4> guarded = splat_constants(view, kCutoff, 0.0);
  const auto is_finite = [&](const Surfel& surfel, const std::vector<Vec4>& constants) {
    return kernels::is_finite(
        run_quads(program, Arithmetic::ieee, constants, std::vector<Surfel>{surfel})[0]);
  };
  const auto without = [&](std::size_t index, std::size_t component) {
    std::vector<Vec4> constants = guarded;
    constants[index][component] = 0.0f;
    return constants;
  };
  const Surfel facing = surfel_at({0, 0, 2}, {0.01, 0, 0}, {0, 0.01, 0});
  const Surfel edge_on = surfel_at({0, 0, 2}, {0.01, 0, 0}, {0, 0, 0.01});
  const Surfel at_eye = surfel_at({0.1, 0.1, 0}, {0.01, 0, 0}, {0, 0.01, 0});
  const Surfel zero = surfel_at({0, 0, 2}, {0, 0, 0}, {0, 0, 0});
  for (const Surfel& surfel : {facing, edge_on, at_eye, zero}) EXPECT_TRUE(is_finite(surfel, guarded));
  EXPECT_FALSE(is_finite(at_eye, without(3, 2)));   // o_z >= near
  EXPECT_FALSE(is_finite(zero, without(7, 0)));     // (S + T)^2 + 1e-16
  EXPECT_FALSE(is_finite(edge_on, without(7, 1)));  // D^2 + 1e-11 (S + T)^2
  EXPECT_FALSE(is_finite(facing, without(7, 3)));   // |p| >= 1e-15
}

// Any position and tangents, orthogonal or not, zero or not, up to 1e6 times the near distance and more:
// finite.
class Hostile {
 public:
  explicit Hostile(std::uint32_t seed) : generator_(seed) { std::printf("seed %u\n", seed); }
  double uniform() { return uniform_(generator_); }
  double number(double low, double high) {  // powers of ten, either sign, or 0
    if (uniform() < 0.15) return 0.0;
    const double magnitude = std::pow(10.0, low + (high - low) * uniform());
    return uniform() < 0.5 ? magnitude : -magnitude;
  }
  glm::dvec3 vector(double low, double high) {
    return {number(low, high), number(low, high), number(low, high)};
  }

 private:
  std::mt19937 generator_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

void expect_finite(const SplatProgram& program, const std::vector<Surfel>& surfels) {
  for (const Arithmetic arithmetic : {Arithmetic::ieee, Arithmetic::nv20}) {
    const auto quads = run_quads(program, arithmetic, exact_view(), 0.0, surfels);
    for (std::size_t i = 0; i < surfels.size(); ++i) {
      ASSERT_TRUE(is_finite(quads[i])) << "surfel " << i << ", o_z = " << surfels[i].position.z;
    }
  }
}

TEST(SpecialCasesOfThePaper, HostileSurfelsStayFinite) {
  Hostile hostile(99);
  for (const double low : {-6.0, -30.0}) {
    std::vector<Surfel> surfels(50000);
    for (Surfel& surfel : surfels) {
      surfel = surfel_at(hostile.vector(low, 6), hostile.vector(low, 6), hostile.vector(low, 6));
      surfel.sigma = std::pow(10.0, -3.0 + 6.0 * hostile.uniform());
    }
    expect_finite(ewa_program("paper"), surfels);
  }
}

// The same with s and t as the recorder makes them, at right angles and of one length, from 1e-6 to 1e6, in
// front of the near plane. Only the paper's program promises finite numbers for what lies behind it.
TEST_P(SpecialCases, HostilePositionsAndSizesStayFinite) {
  Hostile hostile(100);
  for (const double low : {-6.0, -30.0}) {
    std::vector<Surfel> surfels(50000);
    for (Surfel& surfel : surfels) {
      glm::dvec3 normal = hostile.vector(low, 6);
      if (normal == glm::dvec3(0)) normal = {0, 0, -1};
      normal = glm::normalize(normal);
      const glm::dvec3 axis = std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
      const glm::dvec3 s = glm::normalize(glm::cross(axis, normal));
      const double h = std::pow(10.0, -6.0 + 12.0 * hostile.uniform());
      surfel = surfel_at(hostile.vector(low, 6), h * s, h * glm::cross(normal, s));
      glm::dvec3& o = surfel.position;
      o.z = std::max(std::abs(o.z), exact_view().near_plane);
      o = {std::clamp(o.x, -1000 * o.z, 1000 * o.z), std::clamp(o.y, -1000 * o.z, 1000 * o.z), o.z};
      surfel.sigma = std::pow(10.0, -3.0 + 6.0 * hostile.uniform());
    }
    expect_finite(GetParam(), surfels);
  }
}

// A finite float of any size, in [-1, 1].
rc::Gen<double> fraction() {
  return rc::gen::map(
      rc::gen::suchThat(rc::gen::arbitrary<std::uint32_t>(),
                        [](std::uint32_t bits) { return (bits & 0x7f800000u) != 0x7f800000u; }),
      [](std::uint32_t bits) {
        const double x = std::bit_cast<float>(bits);
        return std::abs(x) > 1 ? 1 / x : x;
      });
}

// Nothing comes nearer to the eye than half the centre's depth, so nothing reaches further in the window than
// twice what the exact filter does: a splat is larger than the frame only where the filter is larger than
// half of it. Edge-on, too, and up to the size that the recorder draws.
RC_GTEST_PROP(SpecialCasesOfThePaper, NoCornerComesNearerThanHalfTheDepth, ()) {
  const View view = exact_view();
  const double depth = view.near_plane * std::pow(8000.0, std::abs(*fraction()));
  const glm::dvec3 o{depth * *fraction(), depth * *fraction(), depth};
  const double tilt = 0.5 * std::numbers::pi * *fraction(), turn = std::numbers::pi * *fraction();
  // The normal turns from facing the eye to edge-on, and on by next to nothing from either.
  const glm::dvec3 ray = glm::normalize(o), across = glm::normalize(glm::cross(ray, glm::dvec3(0, 1, 0)));
  const double cosine = *rc::gen::arbitrary<bool>() ? std::cos(tilt) : std::sin(tilt);
  const glm::dvec3 normal = -cosine * ray + std::sqrt(1 - cosine * cosine) * across;
  const glm::dvec3 a = glm::normalize(glm::cross(normal, glm::dvec3(0.1, 1, 0.2))), b = glm::cross(normal, a);
  const double h = 1e9 * depth / view.eta * std::abs(*fraction());
  Surfel surfel = surfel_at(o, h * (std::cos(turn) * a + std::sin(turn) * b),
                            h * (std::cos(turn) * b - std::sin(turn) * a));
  surfel.sigma = 0.3 + std::abs(*fraction());
  for (const Arithmetic arithmetic : {Arithmetic::ieee, Arithmetic::nv20}) {
    const std::vector<Surfel> one{surfel};
    const QuadOutput quad = run_quads(ewa_program("paper"), arithmetic, view, 0.0, one)[0];
    for (const CornerOutput& corner : quad) RC_ASSERT(corner.position.w >= 0.499 * depth);
  }
}

}  // namespace
}  // namespace splatscope::kernels
