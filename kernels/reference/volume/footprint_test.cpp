#include "kernels/reference/volume/footprint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <random>

#include "kernels/reference/surfel_filter.h"
#include "kernels/reference/volume/volume.h"

namespace splatscope::kernels {
namespace {

View test_view() {
  View view = look_at({2, -3, 5}, {0.1, 0.2, -0.1}, {0.3, 1, 0.1}, 40, 300, 200, 0.01, 100);
  view.object_to_camera *= glm::scale(glm::dmat4(1.0), glm::dvec3(1.3));  // uniform, as Eq. 9 allows
  return view;
}

struct Kernel {
  glm::dvec3 position;
  glm::dmat3 variance;
};

Kernel random_kernel(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> coordinate(-1, 1), radius(0.4, 1.6);
  glm::dmat3 axes;
  for (int i = 0; i < 3; ++i) {
    axes[i] = glm::normalize(glm::dvec3(coordinate(random), coordinate(random), coordinate(random)));
    axes[i] *= size * radius(random);
  }
  return {{coordinate(random), coordinate(random), coordinate(random)}, axes * glm::transpose(axes)};
}

double gaussian(const glm::dmat3& variance, const glm::dvec3& d) {
  const double tau = 2 * std::numbers::pi;
  return std::exp(-0.5 * glm::dot(d, glm::inverse(variance) * d)) /
         (std::pow(tau, 1.5) * std::sqrt(glm::determinant(variance)));
}

// Eq. 11 by the trapezoidal rule, in object space: along the ray of x, in steps of half the narrowest width
// that the kernel can have there; exact to rounding for Gaussians.
double integrated(const View& view, Projection projection, const Kernel& kernel, const glm::dvec2& x) {
  const glm::dmat4 to_object = glm::inverse(view.object_to_camera);
  const auto object = [&](double distance) {
    return glm::dvec3(to_object * glm::dvec4(from_ray_space(view, projection, {x, distance}), 1.0));
  };
  const double distance = ray_space(view, projection, view.camera_space(kernel.position)).position.z;
  const double unit = glm::length(object(distance + 1) - object(distance));  // object units a camera unit
  const glm::dvec3 direction = object(distance + 1) - object(distance);
  const double width = 1 / std::sqrt(glm::dot(direction, glm::inverse(kernel.variance) * direction));
  const double widest =
      std::sqrt(kernel.variance[0][0] + kernel.variance[1][1] + kernel.variance[2][2]) / unit;
  double sum = 0;
  const double step = 0.5 * width;
  const int steps = static_cast<int>(9 * widest / step) + 1;
  for (int i = -steps; i <= steps; ++i) {
    sum += gaussian(kernel.variance, object(distance + i * step) - kernel.position);
  }
  return sum * step;
}

// Eq. 14: that, convolved with a Gaussian of variance I, by the trapezoidal rule again.
double filtered(const View& view, Projection projection, const Kernel& kernel, const glm::dvec2& x) {
  constexpr double kStep = 0.4;
  constexpr int kSteps = 19;  // e^-29 beyond
  double sum = 0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const glm::dvec2 offset{kStep * i, kStep * j};
      sum += std::exp(-0.5 * glm::dot(offset, offset)) * integrated(view, projection, kernel, x - offset);
    }
  }
  return sum * kStep * kStep * 0.5 * std::numbers::inv_pi;
}

TEST(VolumeFootprint, IsTheIntegratedAndFilteredKernelAlongOrthographicRays) {
  constexpr unsigned kSeed = 24;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  View view = test_view();
  view.eta = 40;  // pixels a camera unit
  for (int i = 0; i < 6; ++i) {
    const Kernel kernel = random_kernel(random, 0.04 * (i + 1));
    const auto print = footprint(view, Projection::orthographic, VolumePrefilter::ewa,
                                 view.camera_space(kernel.position), camera_variance(view, kernel.variance));
    ASSERT_TRUE(print);
    for (int j = 0; j < 2; ++j) {
      const glm::dvec2 x = print->center + glm::dvec2(place(random), place(random)) * print->reach(1);
      const double expected = filtered(view, Projection::orthographic, kernel, x);
      EXPECT_NEAR(print->value(x) / expected, 1, 1e-9) << "kernel " << i << ", " << x.x << " " << x.y;
    }
  }
}

TEST(VolumeFootprint, IsExactOnItsOwnRayInPerspectiveAndErrsElsewhereByTheOpeningAngle) {
  constexpr unsigned kSeed = 9;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  const View view = test_view();
  for (int i = 0; i < 20; ++i) {
    Kernel kernel = random_kernel(random, 0.1);
    double error[2];
    for (double& e : error) {  // a kernel, and the same ten times smaller
      const glm::dvec3 camera = view.camera_space(kernel.position);
      const glm::dmat3 variance = camera_variance(view, kernel.variance);
      const auto print = footprint(view, Projection::perspective, VolumePrefilter::none, camera, variance);
      ASSERT_TRUE(print);
      const auto exact = [&](const glm::dvec2& x) {
        return exact_integral(view, Projection::perspective, camera, variance, x);
      };
      EXPECT_NEAR(print->value(print->center) / exact(print->center), 1, 1e-9);
      EXPECT_NEAR(integrated(view, Projection::perspective, kernel, print->center) / print->peak, 1, 1e-9);
      const glm::dvec2 beside = print->center + print->reach(1);
      EXPECT_NEAR(integrated(view, Projection::perspective, kernel, beside) / exact(beside), 1, 1e-9);
      e = std::abs(print->value(beside) - exact(beside)) / print->peak;
      kernel.variance /= 100.0;
    }
    EXPECT_LT(error[0], 0.2);
    EXPECT_LT(error[1], 0.2 * error[0]) << i;  // it is of first order
  }
}

TEST(VolumeFootprint, JacobianIsTheDerivativeOfTheMapToRaySpace) {
  const View view = test_view();
  const glm::dvec3 camera{0.7, -0.4, 2.5};
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const RaySpace ray = ray_space(view, projection, camera);
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0.0);
      step[axis] = 1e-5;
      const glm::dvec3 slope = (ray_space(view, projection, camera + step).position -
                                ray_space(view, projection, camera - step).position) /
                               2e-5;
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(ray.jacobian[axis][i], slope[i], 1e-6) << axis << i;
    }
    const glm::dvec3 back = from_ray_space(view, projection, ray.position);
    EXPECT_NEAR(glm::length(back - camera), 0, 1e-12);
  }
}

// sigma^2 J J^T written out, of a sphere.
TEST(VolumeFootprint, OfASphericalKernel) {
  const View view = test_view();
  const double sigma_squared = 0.03;
  const glm::dvec3 camera{0.7, -0.4, 2.5};
  const auto print =
      footprint(view, Projection::perspective, VolumePrefilter::none, camera, glm::dmat3(sigma_squared));
  ASSERT_TRUE(print);
  const glm::dvec2 slope{camera.x / camera.z, -camera.y / camera.z};
  const double scale = view.eta / camera.z;
  const glm::dmat2 variance =
      sigma_squared * scale * scale * (glm::dmat2(1.0) + glm::outerProduct(slope, slope));
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(print->variance[i / 2][i % 2], variance[i / 2][i % 2], 1e-9);
}

TEST(VolumeFootprint, SwansScalingBringsTheSmallerRadiusToTheLowPassAndKeepsTheShape) {
  const glm::dmat2 thin{4, 0.3, 0.3, 0.25}, wide{4, 0.3, 0.3, 2};
  const glm::dmat2 scaled = prefiltered(VolumePrefilter::swan, thin);
  EXPECT_NEAR(scaled[0][0] / scaled[1][1], 16, 1e-12);
  const double trace = scaled[0][0] + scaled[1][1], determinant = glm::determinant(scaled);
  EXPECT_NEAR(0.5 * trace - std::sqrt(0.25 * trace * trace - determinant), 1, 1e-12);
  EXPECT_EQ(prefiltered(VolumePrefilter::swan, wide), wide);
}

// Eq. 37: in the limit both paths have the same variance.
TEST(VolumeFootprint, FlattenedKernelsAreSurfaceSplats) {
  constexpr unsigned kSeed = 37;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  View view = look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 40, 300, 200, 0.01, 100);
  for (int i = 0; i < 100; ++i) {
    const double h = 0.1;
    const glm::dvec3 normal =
        glm::normalize(glm::dvec3(coordinate(random), coordinate(random), coordinate(random)));
    const glm::dvec3 s = h * glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, -0.7)));
    const glm::dvec3 t = glm::cross(normal, s);
    const Surfel surfel{
        .position = {coordinate(random), coordinate(random), 0}, .tangent_s = s, .tangent_t = t};
    const auto filter = surfel_filter(view, surfel, false);
    ASSERT_TRUE(filter);
    const glm::dmat2 surface = filter->jacobian * filter->variance * glm::transpose(filter->jacobian);
    const glm::dmat3 flat = flattened(glm::dmat3(h * h), normal, 1e4);
    const RaySpace ray = ray_space(view, Projection::perspective, view.camera_space(surfel.position));
    const glm::dmat2 volume = projected_variance(ray, camera_variance(view, flat));
    // Relative to the trace: seen edge-on, a single entry may be next to nothing.
    const double scale = surface[0][0] + surface[1][1];
    for (int j = 0; j < 4; ++j) {
      EXPECT_NEAR(volume[j / 2][j % 2] / scale, surface[j / 2][j % 2] / scale, 1e-6) << i;
    }
  }
}

TEST(VolumeFootprint, NothingAtOrBeforeTheNearPlane) {
  View view = test_view();
  view.near_plane = 1;
  const glm::dmat3 variance(0.1);
  EXPECT_FALSE(footprint(view, Projection::perspective, VolumePrefilter::ewa, {0, 0, 1}, variance));
  EXPECT_TRUE(footprint(view, Projection::perspective, VolumePrefilter::ewa, {0, 0, 1.1}, variance));
}

}  // namespace
}  // namespace splatscope::kernels
