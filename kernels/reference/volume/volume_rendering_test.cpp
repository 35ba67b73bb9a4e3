#include "kernels/reference/volume/volume_rendering.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <optional>
#include <random>

#include "kernels/reference/volume/fast_volume.h"
#include "kernels/reference/volume/procedural.h"
#include "model/testing/simd_targets.h"

namespace splatscope::kernels {
namespace {

const TransferFunction kGlass({{0, {0.3, {1, 0.5, 0.25}}}});
constexpr PhongLight kUnshaded{.ambient = 1, .diffuse = 0, .specular = 0};

glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

// Where the ray of a pixel meets a layer of voxels, in voxels from the first; `cosine` gets that between the
// ray and the axis.
glm::dvec3 hit(const View& view, Projection projection, const Volume& volume, glm::dvec2 pixel, int axis,
               int layer, double& cosine) {
  const glm::dmat4 to_object = glm::inverse(view.object_to_camera);
  const auto object = [&](double distance) {
    return glm::dvec3(to_object * glm::dvec4(from_ray_space(view, projection, {pixel, distance}), 1.0));
  };
  const glm::dvec3 start = object(1), direction = object(2) - start;
  cosine = std::abs(direction[axis]) / glm::length(direction);
  const double plane = volume.origin[axis] + layer * volume.spacing[axis];
  return (start + (plane - start[axis]) / direction[axis] * direction - volume.origin) / volume.spacing;
}

// Compares the opacity of each pixel whose ray passes all layers at least four voxels from their edges with
// what a constant volume has there. Returns how many there are.
int expect_constant(const View& view, Projection projection, int axis) {
  glm::ivec3 size(44);
  size[axis] = 3;
  const Volume volume = constant_volume(size, {0.1, 0.1, 0.1});
  const VolumePicture picture =
      volume_picture(view, grid_splats(volume, kGlass), {.projection = projection, .light = kUnshaded});
  int compared = 0;
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column) {
      bool inside = true;
      double cosine = 1;
      for (const int layer : {0, size[axis] - 1}) {
        glm::dvec3 at = hit(view, projection, volume, {column + 0.5, row + 0.5}, axis, layer, cosine);
        for (int i = 0; i < 3; ++i) inside = inside && (i == axis || (at[i] > 4 && at[i] < size[i] - 5));
      }
      if (!inside) continue;
      const double expected = 1 - std::pow(1 - 0.3 / cosine, size[axis]);
      const glm::dvec4 pixel = picture.pixels[static_cast<std::size_t>(row * view.width + column)];
      EXPECT_NEAR(pixel.w / expected, 1, 0.0025) << column << " " << row;
      EXPECT_NEAR(pixel.y / pixel.w, 0.5, 1e-9);
      ++compared;
    }
  }
  return compared;
}

TEST(VolumeRendering, ConstantVolumeIsConstantAtAnyOrientation) {
  constexpr unsigned kSeed = 5;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  int compared = 0;
  for (int i = 0; i < 8; ++i) {
    // Straight on, where the lattice shows most, along each axis; then anywhere.
    glm::dvec3 eye = random_direction(random);
    if (i < 3) eye = glm::dvec3(i == 0, i == 1, i == 2);
    View view = look_at(8.0 * eye, {0, 0, 0}, random_direction(random), 30, 150, 150, 0.1, 100);
    const int axis = eye.x * eye.x > 0.5 ? 0 : eye.y * eye.y > 0.5 ? 1 : 2;
    int nearest = axis;
    for (int a = 0; a < 3; ++a) {
      if (std::abs(eye[a]) > std::abs(eye[nearest])) nearest = a;
    }
    compared += expect_constant(view, Projection::perspective, nearest);
    view.eta = 25 + 10 * i;  // pixels a unit
    compared += expect_constant(view, Projection::orthographic, nearest);
  }
  EXPECT_GT(compared, 20000);
}

// Two voxels, one before the other, along every axis both ways.
TEST(VolumeRendering, WhatIsNearerHidesWhatIsFurther) {
  const TransferFunction transfer({{1, {1, {1, 0, 0}}}, {2, {1, {0, 1, 0}}}});
  for (int direction = 0; direction < 6; ++direction) {
    glm::ivec3 size(1);
    size[direction / 2] = 2;
    Volume volume = centered_volume(size, glm::dvec3(1));
    volume.values = {1, 2};
    glm::dvec3 eye(0.0);
    eye[direction / 2] = direction % 2 ? 6 : -6;
    const View view = look_at(eye, {0, 0, 0}, {0.3, 0.5, 0.7}, 30, 40, 40, 0.1, 100);
    // Opaque where the Gaussian's peak, 1/(2 pi), is brought above 1.
    VolumeSplats splats = grid_splats(volume, transfer);
    for (VolumeSplat& splat : splats.splats) splat.weight *= 10;
    const VolumePicture picture = volume_picture(view, splats, {.light = kUnshaded});
    const glm::dvec4 center = picture.pixels[20 * 40 + 20];
    EXPECT_NEAR(center[direction % 2 ? 1 : 0], 1, 1e-9) << direction;
    EXPECT_NEAR(center[direction % 2 ? 0 : 1], 0, 1e-9) << direction;
    EXPECT_EQ(picture.sheets, 2u);
    const int other = (direction / 2 + 1) % 3;
    EXPECT_EQ(volume_picture(view, splats, {.light = kUnshaded, .axis = other}).sheets, 1u);
  }
}

TEST(VolumeRendering, OpacityOfFlatKernelsDoesNotGrowWithTheirSlope) {
  const Volume volume = constant_volume({60, 60, 1}, glm::dvec3(0.1));
  const VolumeSplats splats =
      grid_splats(volume, kGlass, 1, {.low = 0, .high = 1, .normal = glm::dvec3(0, 0, 1)});
  for (const double angle : {0.0, 0.4, 0.7}) {
    const glm::dvec3 eye{0, 20 * std::sin(angle), 20 * std::cos(angle)};
    const View view = look_at(eye, {0, 0, 0}, {0, 1, 0}, 10, 60, 60, 0.1, 100);
    const VolumePicture picture = volume_picture(view, splats, {.light = kUnshaded});
    EXPECT_NEAR(picture.pixels[30 * 60 + 30].w, 0.3, 0.3 * 0.0025) << angle;
  }
}

// From a layer of volume splats to a surface without a step, whatever the cells are like.
TEST(VolumeRendering, TheFlatterAKernelTheLessItsOpacityGrowsWithItsSlope) {
  for (const double depth : {0.1, 0.02}) {
    const Volume volume = constant_volume({60, 60, 1}, {0.1, 0.1, depth});
    const double straight_on = 0.3 * std::cbrt(depth * depth / 0.01);
    for (const double s : {1.0, 1.0001, 1.5, 4.0, 1e4}) {
      const VolumeSplats splats =
          grid_splats(volume, kGlass, 1, {.low = 0, .high = 1, .s = s, .normal = glm::dvec3(0, 0, 1)});
      for (const double angle : {0.0, 0.4, 0.7}) {
        const glm::dvec3 eye{0, 20 * std::sin(angle), 20 * std::cos(angle)};
        const View view = look_at(eye, {0, 0, 0}, {0, 1, 0}, 10, 60, 60, 0.1, 100);
        const VolumeSettings settings{.light = kUnshaded, .axis = 2};
        const double expected = straight_on * std::hypot(1, std::tan(angle) / s);
        EXPECT_NEAR(volume_picture(view, splats, settings).pixels[30 * 60 + 30].w / expected, 1, 0.0025)
            << depth << " " << s << " " << angle;
        EXPECT_NEAR(FastVolume(splats).draw(view, settings).pixels[30 * 60 + 30].w / expected, 1, 0.0075)
            << depth << " " << s << " " << angle;
      }
    }
  }
}

// A quarter of a ring and a whole one: where layers bend round, some would be composited from front to back.
TEST(VolumeRendering, SheetsAreTheLayersOfAGridWhereAllFaceTheEye) {
  const Volume grid = constant_volume({16, 4, 3}, glm::dvec3(1));
  const auto axis_seen_from = [&](double turns, const glm::dvec3& eye) {
    const auto [samples, layers] = curvilinear_samples(grid, 1, [&](const glm::ivec3& voxel) {
      const double angle = 2 * std::numbers::pi * turns * (voxel.x / 15.0 - 0.5), radius = 3 + voxel.y;
      return glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), voxel.z);
    });
    const VolumeSplats splats = sample_splats(samples, kGlass, 1, {}, layers);
    return sheet_axis(look_at(eye, {0, 0, 0}, {0.3, 0.2, 1}, 30, 40, 40, 0.1, 100), splats, std::nullopt);
  };
  for (const double turns : {0.25, 1.0}) {
    EXPECT_EQ(axis_seen_from(turns, {0, 4, -30}).axis, kLayerAxes + 2) << turns;
    EXPECT_FALSE(axis_seen_from(turns, {0, 4, -30}).last_is_nearest) << turns;
    EXPECT_TRUE(axis_seen_from(turns, {0, 4, 30}).last_is_nearest) << turns;
  }
  EXPECT_EQ(axis_seen_from(0.25, {30, 1, 1}).axis, kLayerAxes + 1);
  EXPECT_TRUE(axis_seen_from(0.25, {30, 1, 1}).last_is_nearest);
  EXPECT_EQ(axis_seen_from(1, {30, 1, 1}).axis, 0) << "across x of object space";
}

TEST(VolumeRendering, EmptyVoxelsAreLeftOut) {
  Volume volume = constant_volume({4, 5, 6}, glm::dvec3(1));
  volume.values[7] = 5;
  const TransferFunction transfer({{1, {0, {}}}, {5, {1, {1, 1, 1}}}});
  const VolumeSplats splats = grid_splats(volume, transfer);
  ASSERT_EQ(splats.splats.size(), 1u);
  EXPECT_EQ(splats.empty, 119u);
  EXPECT_EQ(splats.splats[0].position, glm::vec3(volume.position({3, 1, 0})));
}

// As of a curvilinear grid whose layers lie in one another.
TEST(VolumeRendering, SamplesWhoseCellHasNoSizeAreEmpty) {
  const VolumeSample flat{.position = {1, 2, 3}, .variance = glm::dmat3(1), .cell = 0, .value = 1};
  VolumeSample whole = flat;
  whole.cell = 1;
  const VolumeSplats splats = sample_splats(std::vector{flat, whole, flat}, kGlass, 1);
  EXPECT_EQ(splats.splats.size(), 1u);
  EXPECT_EQ(splats.kernels.size(), 1u);
  EXPECT_EQ(splats.empty, 2u);
}

TEST(VolumeRendering, VoxelsWithoutAFootprintLeaveNoTrace) {
  VolumeSplats splats = grid_splats(constant_volume({5, 5, 5}, glm::dvec3(1)), kGlass);
  splats.splats[3].position.x = NAN;
  splats.splats[4].position = {1e30f, 0, 0};
  splats.splats[5].weight = INFINITY;
  const View view = look_at({0, 0, -1}, {0, 0, 0}, {0, 1, 0}, 90, 50, 40, 0.1, 100);  // from among them
  for (const glm::vec4& pixel : FastVolume(splats).draw(view, {}).pixels) {
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(std::isfinite(pixel[i]));
  }
}

// Largest difference of r g b and opacity.
double difference(const FastVolumePicture& fast, const VolumePicture& exact) {
  double most = 0;
  for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
    for (int c = 0; c < 4; ++c) {
      most = std::max(most, std::abs(static_cast<double>(fast.pixels[i][c]) - exact.pixels[i][c]));
    }
  }
  return most;
}

const TransferFunction kTissue({{0.1, {0, {0.9, 0.6, 0.5}}},
                                {0.25, {0.05, {0.9, 0.6, 0.5}}},
                                {0.5, {0.1, {0.9, 0.8, 0.7}}},
                                {0.7, {0.9, {1, 1, 0.9}}}});

// The table is off by 11/2048 of a kernel's value where it lies in the middle between two of its entries, and
// that partly evens out in a sum.
constexpr double kTableError = 11.0 / 2048;

TEST(FastVolume, IsThePictureOfTheDoublePrecisionRenderer) {
  const Volume head = head_stand_in({40, 40, 20});
  const auto bent = [&](const glm::ivec3& voxel) {
    const glm::dvec3 p = head.position(voxel);
    return p + glm::dvec3(0.2 * p.y * p.y, 0.1 * p.x, 0);
  };
  const PlacedSamples placed = curvilinear_samples(head, 1, bent);
  const VolumeSplats cases[] = {
      grid_splats(head, kTissue),  // its z spacing is not that of x and y
      grid_splats(head, kTissue, 1, {.low = 0.6, .high = 1}),
      grid_splats(concentric_shells(24, 3), kTissue),  // spherical kernels
      sample_splats(placed.samples, kTissue, 0.1),
      sample_splats(placed.samples, kTissue, 0.1, {.low = 0.6, .high = 1, .s = 50}, placed.layers)};
  const View view = look_at({1.5, -3.4, 1}, {0, 0, 0}, {0, 0, 1}, 35, 101, 90, 0.1, 100);
  for (const VolumeSplats& splats : cases) {
    FastVolume fast(splats);
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
      for (const VolumePrefilter prefilter :
           {VolumePrefilter::ewa, VolumePrefilter::swan, VolumePrefilter::none}) {
        View scaled = view;
        if (projection == Projection::orthographic) scaled.eta = 36;
        // Flat kernels are lines where seen edge-on: without a low-pass, a matter of rounding.
        const bool flat = &splats == &cases[1] || &splats == &cases[4];
        if (flat && prefilter != VolumePrefilter::ewa) continue;
        const VolumeSettings settings{.projection = projection,
                                      .prefilter = prefilter,
                                      .light = {.toward_light = {0.6, 0.64, -0.48}},
                                      .axis = {}};
        const VolumePicture exact = volume_picture(scaled, splats, settings);
        EXPECT_LT(difference(fast.draw(scaled, settings), exact), kTableError)
            << &splats - cases << " " << static_cast<int>(projection) << " " << static_cast<int>(prefilter);
        double most = 0;
        for (const glm::dvec4& pixel : exact.pixels) most = std::max(most, pixel.w);
        EXPECT_GT(most, 0.5);
      }
    }
  }
}

// Whose footprints are thousands of times longer than wide.
TEST(FastVolume, IsThatPictureWithVoxelsNextToTheEyesPlane) {
  for (const double spacing_z : {0.5, 0.3}) {  // spherical kernels, and others
    const Volume volume = constant_volume({4, 4, 4}, {0.5, 0.5, spacing_z});
    for (const std::optional<glm::dvec3>& normal :
         {std::optional<glm::dvec3>(), std::optional(glm::normalize(glm::dvec3(1, 2, 3)))}) {
      const VolumeSplats splats =
          grid_splats(volume, kGlass, 1, {.low = normal ? 0.0 : 2.0, .high = 1, .s = 100, .normal = normal});
      FastVolume fast(splats);
      for (const double distance : {0.1, 0.01, 1e-3, 1e-4}) {
        const double z = -0.5 * spacing_z - distance;
        const View view = look_at({0.15, 0.1, z}, {0.15, 0.1, 1.5}, {0, 1, 0}, 60, 64, 48, 1e-6, 10);
        const VolumeSettings settings{.light = kUnshaded};
        const VolumePicture exact = volume_picture(view, splats, settings);
        const FastVolumePicture single = fast.draw(view, settings);
        EXPECT_LT(difference(single, exact), kTableError)
            << spacing_z << " " << normal.has_value() << " " << distance;
        EXPECT_EQ(single.left_out, exact.left_out);
      }
    }
  }
}

// The least of the variances is lost in the sums of the others that a turned camera makes of them.
TEST(FastVolume, IsThatPictureOfLongVoxelsSeenAlongThem) {
  for (const double ratio : {100.0, 1000.0}) {
    const VolumeSplats splats = grid_splats(constant_volume({31, 31, 1}, {1 / ratio, 1 / ratio, 1}), kGlass);
    FastVolume fast(splats);
    for (const double distance : {20 / ratio, 100 / ratio}) {
      const View view = look_at({0, 0, -distance}, {0.6 * distance, 0.4 * distance, 0}, {0.3, 1, 0}, 90, 300,
                                300, 0.01 * distance, 1000 * distance);
      const VolumeSettings settings{.light = kUnshaded};
      const double most = difference(fast.draw(view, settings), volume_picture(view, splats, settings));
      EXPECT_LT(most, kTableError) << ratio << " " << distance;
    }
  }
}

TEST(FastVolume, SameBitsForAnyNumberOfThreadsAndEverySimdTarget) {
  FastVolume volume(grid_splats(head_stand_in({60, 60, 30}), kTissue, 1, {.low = 0.6, .high = 1}));
  const View view = look_at({-1.5, -3.4, -1}, {0, 0, 0}, {0, 0, 1}, 35, 101, 90, 0.1, 100);
  const FastVolumePicture picture = volume.draw(view, {});
  for (const std::size_t threads : {1, 3}) {
    const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(volume.draw(view, {}).pixels, picture.pixels) << threads;
  }
  splatscope::testing::on_each_simd_target([&] { EXPECT_EQ(volume.draw(view, {}).pixels, picture.pixels); });
}

TEST(VolumeRendering, SameBitsForAnyNumberOfThreads) {
  const VolumeSplats splats = grid_splats(head_stand_in({30, 30, 20}), kTissue);
  const View view = look_at({-1.5, -3.4, -1}, {0, 0, 0}, {0, 0, 1}, 35, 61, 60, 0.1, 100);
  const VolumePicture picture = volume_picture(view, splats, {});
  const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(volume_picture(view, splats, {}).pixels, picture.pixels);
}

}  // namespace
}  // namespace splatscope::kernels
