#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "kernels/object_space_ewa/quad_runner.h"

// Where the formulas of the paper break or their guards act: t = 0, p = 0 with B < 0, D = 0, behind the eye,
// and finite numbers that no scene has.
namespace splatscope::kernels {
namespace {

constexpr double kCutoff = 1.0;

// Camera space is object space.
View plain_view() {
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

bool finite(const QuadOutput& quad) {
  for (const CornerOutput& corner : quad) {
    for (int i = 0; i < 4; ++i) {
      if (!std::isfinite(corner.position[i]) || !std::isfinite(corner.diffuse[i])) return false;
    }
  }
  return true;
}

QuadOutput run_one(const Surfel& surfel, const std::vector<Vec4>& constants,
                   Arithmetic arithmetic = Arithmetic::ieee) {
  return run_quads(load_program(kEwaProgram), arithmetic, constants, std::vector<Surfel>{surfel})[0];
}

glm::dvec3 camera_space(const View& view, const glm::vec4& clip) {
  return {clip.x * 0.5 * view.width / view.eta, clip.y * 0.5 * view.height / view.eta, clip.w};
}

// Camera-space vectors of the parallelogram: p_c = o + y0 a + y1 b.
struct Parallelogram {
  glm::dvec3 a, b;
};
Parallelogram parallelogram(const View& view, const QuadOutput& quad) {
  const auto corner = [&](std::size_t i) { return camera_space(view, quad[i].position); };
  const double side = 2.0 * std::sqrt(2.0 * kCutoff);
  return {(corner(1) - corner(0)) / side, (corner(3) - corner(0)) / side};
}

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

TEST(AppendixA, printed_sign_is_wrong_where_p_is_0_and_b_negative) {
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
TEST(SpecialCases, p_is_0) {
  const View view = plain_view();
  const double tilt = std::sqrt(0.375);
  for (const double direction : {-1.0, 1.0}) {
    const Surfel surfel = surfel_at({0, 0, 2}, 0.01 * glm::dvec3(0.75, 0.25, tilt),
                                    direction * 0.01 * glm::dvec3(0.25, 0.75, -tilt));
    const SurfelFilter filter = *surfel_filter(view, surfel, true);
    ASSERT_NEAR(filter.variance[0][0] - filter.variance[1][1], 0.0, 1e-12);
    ASSERT_LT(direction * filter.variance[0][1], -0.01);
    const Parallelogram splat = parallelogram(view, run_one(surfel, splat_constants(view, kCutoff, 0.0)));
    const glm::dvec3 s = surfel.tangent_s;
    const glm::dvec3 t = surfel.tangent_t;
    const auto coordinates = [&](const glm::dvec3& v) {
      return glm::dvec2(glm::dot(v, s) / glm::dot(s, s), glm::dot(v, t) / glm::dot(t, t));
    };
    const glm::dmat2 axes{coordinates(splat.a), coordinates(splat.b)};
    expect_near(axes * glm::transpose(axes), filter.variance, 1e-4);
  }
}

// Every surfel of a plane that faces the camera, wherever it is: J is a multiple of I, and Rot(theta) = I.
TEST(SpecialCases, t_is_0) {
  const View view = plain_view();
  for (const double x : {-0.5, 0.0, 0.3}) {
    for (const double y : {-0.4, 0.0, 0.6}) {
      const Surfel surfel = surfel_at({x, y, 2}, {0.01, 0, 0}, {0, 0.01, 0});
      const QuadOutput quad = run_one(surfel, splat_constants(view, kCutoff, 0.0));
      ASSERT_TRUE(finite(quad));
      const Parallelogram splat = parallelogram(view, quad);
      const double r = 0.01 * std::sqrt(1.0 + 1.0 / (2.56 * 2.56));  // h is 2.56 pixels
      EXPECT_LT(glm::distance(splat.a, glm::dvec3(r, 0, 0)), 1e-6);
      EXPECT_LT(glm::distance(splat.b, glm::dvec3(0, r, 0)), 1e-6);
    }
  }
}

// The eye is in the plane of the surfel: infinitely long along the ray, one pixel's filter and its own
// across.
TEST(SpecialCases, d_is_0) {
  const View view = plain_view();
  for (const bool swapped : {false, true}) {
    Surfel surfel = surfel_at({0, 0, 2}, {0.01, 0, 0}, {0, 0, 0.01});
    if (swapped) std::swap(surfel.tangent_s, surfel.tangent_t);
    const QuadOutput quad = run_one(surfel, splat_constants(view, kCutoff, 0.0));
    ASSERT_TRUE(finite(quad));
    const Parallelogram splat = parallelogram(view, quad);
    EXPECT_NEAR(std::abs(splat.b.x), 0.01 * std::sqrt(1.0 + 1.0 / (2.56 * 2.56)), 1e-5);
    EXPECT_GT(std::abs(splat.a.z), 100.0);
    EXPECT_LT(quad[0].diffuse.w, 1e-4);
  }
}

// Each guard of the program, switched off by its constant.
TEST(SpecialCases, guards_act) {
  const View view = plain_view();
  const std::vector<Vec4> guarded = splat_constants(view, kCutoff, 0.0);
  const auto without = [&](std::size_t index, std::size_t component) {
    std::vector<Vec4> constants = guarded;
    constants[index][component] = 0.0f;
    return constants;
  };
  const Surfel facing = surfel_at({0, 0, 2}, {0.01, 0, 0}, {0, 0.01, 0});
  const Surfel edge_on = surfel_at({0, 0, 2}, {0.01, 0, 0}, {0, 0, 0.01});
  const Surfel at_eye = surfel_at({0.1, 0.1, 0}, {0.01, 0, 0}, {0, 0.01, 0});
  const Surfel zero = surfel_at({0, 0, 2}, {0, 0, 0}, {0, 0, 0});
  for (const Surfel& surfel : {facing, edge_on, at_eye, zero}) EXPECT_TRUE(finite(run_one(surfel, guarded)));
  EXPECT_FALSE(finite(run_one(at_eye, without(3, 2))));   // o_z >= near
  EXPECT_FALSE(finite(run_one(zero, without(7, 0))));     // (S + T)^2 + 1e-16
  EXPECT_FALSE(finite(run_one(edge_on, without(7, 1))));  // D^2 + 1e-11 (S + T)^2
  EXPECT_FALSE(finite(run_one(facing, without(7, 3))));   // |p| >= 1e-15
}

// Any position and tangents, orthogonal or not, zero or not, up to 1e6 times the near distance and more:
// finite.
TEST(SpecialCases, hostile_surfels_stay_finite) {
  constexpr std::uint32_t kSeed = 99;
  std::printf("seed %u\n", kSeed);
  std::mt19937 generator(kSeed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto number = [&](double low, double high) {  // powers of ten, either sign, or 0
    if (uniform(generator) < 0.15) return 0.0;
    const double magnitude = std::pow(10.0, low + (high - low) * uniform(generator));
    return uniform(generator) < 0.5 ? magnitude : -magnitude;
  };
  for (const double low : {-6.0, -30.0}) {
    std::vector<Surfel> surfels(50000);
    for (Surfel& surfel : surfels) {
      const auto vector = [&] { return glm::dvec3(number(low, 6), number(low, 6), number(low, 6)); };
      surfel = surfel_at(vector(), vector(), vector());
      surfel.sigma = std::pow(10.0, -3.0 + 6.0 * uniform(generator));
    }
    for (const Arithmetic arithmetic : {Arithmetic::ieee, Arithmetic::nv20}) {
      const auto quads = run_quads(load_program(kEwaProgram), arithmetic,
                                   splat_constants(plain_view(), kCutoff, 0.0), surfels);
      for (std::size_t i = 0; i < surfels.size(); ++i) ASSERT_TRUE(finite(quads[i])) << "surfel " << i;
    }
  }
}

}  // namespace
}  // namespace splatscope::kernels
