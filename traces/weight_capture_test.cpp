#include "traces/weight_capture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "kernels/sphere_points.h"
#include "traces/edges.h"
#include "traces/gamma.h"
#include "traces/neighbours.h"

namespace splatscope::traces {
namespace {

Splatting splatting_of(std::span<const Surfel> surfels) {
  Splatting splatting;
  splatting.cutoff = 1;
  splatting.sigma = 1;
  splatting.circular_cutoff = true;
  splatting.depth_offset = average_spacing(surfels);
  splatting.gamma = suitable_gamma(surfels, splatting);
  return splatting;
}

Capture capture_of(int views, int frame_size) {
  Capture capture;
  capture.views = views;
  capture.frame_size = frame_size;
  capture.box_min = glm::dvec3(-1e30);
  capture.box_max = glm::dvec3(1e30);
  return capture;
}

// A square of `edge` x `edge` units in the plane y = 0, a surfel at random in each unit cell.
std::vector<Surfel> jittered_square(int edge, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0.1, 0.9);
  std::vector<Surfel> surfels;
  for (int row = 0; row < edge; ++row) {
    for (int column = 0; column < edge; ++column) {
      Surfel surfel;
      surfel.position = glm::vec3(column - 0.5 * edge + any(random), 0, row - 0.5 * edge + any(random));
      surfel.normal = {0, 1, 0};
      surfels.push_back(surfel);
    }
  }
  estimate_radii(surfels, 8);
  return surfels;
}

// Points spread evenly over a sphere.
std::vector<Surfel> sphere(int count, double radius) {
  std::vector<Surfel> surfels;
  for (int i = 0; i < count; ++i) {
    Surfel surfel;
    surfel.normal = kernels::sphere_point(i, count).place;
    surfel.position = surfel.normal * static_cast<float>(radius);
    surfels.push_back(surfel);
  }
  estimate_radii(surfels, 8);
  return surfels;
}

// Sum of the reconstruction filters at a point of the plane y = 0, over all surfels (Ren 2002, 7.1).
double exact_sum(std::span<const Surfel> surfels, const glm::dvec3& point) {
  double sum = 0;
  for (const Surfel& surfel : surfels) {
    const double distance = glm::length(point - glm::dvec3(surfel.position)) / surfel.radius;
    if (distance * distance <= 2) sum += 0.5 * std::numbers::inv_pi * std::exp(-0.5 * distance * distance);
  }
  return sum;
}

NumberFormats float_formats() {
  NumberFormats formats;
  formats.frame = FrameFormat::float32;
  formats.color = ColorFormat::float32;
  return formats;
}

bool in_the_middle(const Surfel& surfel, double edge) {
  return std::abs(surfel.position.x) < edge && std::abs(surfel.position.z) < edge;
}

// Weights come from one pixel a view, up to half a pixel away from the centre, with the splats that pass
// through it: the median of the views is near the exact sum, and the mean over the surfels much nearer.
TEST(WeightCapture, WeightsAreTheInversesOfExactSums) {
  for (const unsigned seed : {1u, 2u}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const std::vector<Surfel> surfels = jittered_square(32, seed);
    for (const bool eight_bits : {false, true}) {
      const CapturedWeights captured = capture_weights(surfels, splatting_of(surfels), capture_of(16, 512),
                                                       eight_bits ? NumberFormats{} : float_formats());
      ASSERT_EQ(surfels.size(), captured.captured);
      double sum = 0, largest = 0;
      int count = 0;
      for (std::size_t k = 0; k < surfels.size(); ++k) {
        if (!in_the_middle(surfels[k], 12)) continue;
        const double product = captured.weights[k][0] * exact_sum(surfels, surfels[k].position);
        largest = std::max(largest, std::abs(product - 1));
        sum += product - 1;
        ++count;
        for (const float weight : captured.weights[k]) EXPECT_EQ(captured.weights[k][0], weight);
      }
      EXPECT_LT(std::abs(sum / count), eight_bits ? 0.03 : 0.01);
      EXPECT_LT(largest, 0.12) << "8 bits: " << eight_bits;
    }
  }
}

TEST(WeightCapture, SurfelsAtEdgesHaveAWeightForEachVertex) {
  const std::vector<Surfel> surfels = jittered_square(24, 4);
  Capture capture = capture_of(8, 256);
  const CapturedWeights corners = capture_weights(surfels, splatting_of(surfels), capture, float_formats());
  const std::vector<char> edge = at_edge(surfels);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(edge, 1)), corners.at_edges);
  capture.corner_weights = false;
  const CapturedWeights centres = capture_weights(surfels, splatting_of(surfels), capture, float_formats());
  EXPECT_EQ(0u, centres.at_edges);
  std::size_t different = 0;
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    const auto [low, high] = std::ranges::minmax(corners.weights[k]);
    different += low != high;
    EXPECT_TRUE(edge[k] || low == high);
    EXPECT_LE(high, 2.001f * centres.weights[k][0]) << "half of the sum at the centre is the least";
  }
  EXPECT_GT(different, corners.at_edges * 9 / 10);
}

// The one view lies on +x. Of a square that turns its back to it everything is seen where both faces are
// drawn, nothing where the front is; and what is not seen has no weights of its own at edges.
TEST(WeightCapture, AViewSeesTheFacesThatAreDrawn) {
  std::vector<Surfel> surfels = jittered_square(8, 10);
  for (Surfel& surfel : surfels) {
    surfel.position = {surfel.position.y, surfel.position.x, surfel.position.z};
    surfel.normal = {-1, 0, 0};
  }
  Splatting splatting = splatting_of(surfels);
  const CapturedWeights both = capture_weights(surfels, splatting, capture_of(1, 128), NumberFormats{});
  EXPECT_EQ(both.captured, surfels.size());
  EXPECT_GT(both.at_edges, 0u);
  splatting.faces = Faces::front;
  const CapturedWeights front = capture_weights(surfels, splatting, capture_of(1, 128), NumberFormats{});
  EXPECT_EQ(front.unseen, surfels.size());
  EXPECT_EQ(front.at_edges, 0u);
  EXPECT_EQ(front.weights[0], equal_weights(1)) << "there is no median";
}

// Views that see nothing well are left out. One more surfel, which faces these, brings them back.
TEST(WeightCapture, ViewsLeftOutChangeNoWeight) {
  std::vector<Surfel> surfels = jittered_square(4, 7);  // a surfel's corners are far apart in these views
  const Splatting splatting = splatting_of(surfels);
  surfels.push_back({.position = {5, 0, 0}, .normal = {0, 1, 0}, .radius = 0.001f});
  const Capture capture = capture_of(64, 256);
  const CapturedWeights few = capture_weights(surfels, splatting, capture, float_formats());
  surfels.back().normal = {1, 0, 0};
  const CapturedWeights many = capture_weights(surfels, splatting, capture, float_formats());
  for (std::size_t k = 0; k + 1 < surfels.size(); ++k) EXPECT_EQ(many.weights[k], few.weights[k]) << k;
  EXPECT_GT(few.at_edges, 8u);
}

// The outer sphere hides the inner one from every side.
TEST(WeightCapture, UnseenSurfelsHaveTheMedianAndAreCounted) {
  std::vector<Surfel> surfels = sphere(1500, 1);
  const std::vector<Surfel> inside = sphere(200, 0.5);
  surfels.insert(surfels.end(), inside.begin(), inside.end());
  const CapturedWeights captured =
      capture_weights(surfels, splatting_of(surfels), capture_of(12, 256), NumberFormats{});
  EXPECT_EQ(200u, captured.unseen);
  EXPECT_EQ(1500u, captured.captured);
  EXPECT_EQ(0u, captured.outside_box);
  std::vector<float> weights;
  for (std::size_t k = 0; k < 1500; ++k) weights.push_back(captured.weights[k][0]);
  std::ranges::sort(weights);
  for (std::size_t k = 1500; k < surfels.size(); ++k) {
    EXPECT_NEAR(weights[750], captured.weights[k][0], 0.01 * weights[750]);
  }
}

TEST(WeightCapture, OutsideOfTheBoxNothingIsNormalized) {
  const std::vector<Surfel> surfels = jittered_square(16, 5);
  const Splatting splatting = splatting_of(surfels);
  Capture capture = capture_of(8, 256);
  const CapturedWeights all = capture_weights(surfels, splatting, capture, NumberFormats{});
  capture.box_min.x = -3;
  capture.box_max.z = 2;
  const CapturedWeights boxed = capture_weights(surfels, splatting, capture, NumberFormats{});
  std::size_t outside = 0;
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    const bool in = surfels[k].position.x >= -3 && surfels[k].position.z <= 2;
    outside += !in;
    EXPECT_EQ(in ? all.weights[k] : equal_weights(splatting.gamma), boxed.weights[k]) << k;
  }
  EXPECT_EQ(outside, boxed.outside_box);
  EXPECT_EQ(surfels.size(), boxed.outside_box + boxed.captured);
}

TEST(WeightCapture, HostileSurfelsGetAWeight) {
  std::vector<Surfel> surfels = jittered_square(8, 6);
  EXPECT_TRUE(capture_weights({}, splatting_of(surfels), capture_of(4, 64), NumberFormats{}).weights.empty());
  const Splatting splatting = splatting_of(surfels);
  surfels[3].position = glm::vec3(3e38f, -3e38f, 3e38f);
  surfels[5].radius = 1e38f;
  for (const VertexWeights& weights :
       capture_weights(surfels, splatting, capture_of(4, 64), NumberFormats{}).weights) {
    for (const float weight : weights) EXPECT_TRUE(std::isfinite(weight) && weight > 0);
  }
}

TEST(Edges, OfASquareButNotOfASphere) {
  const std::vector<Surfel> round = sphere(2000, 1);
  EXPECT_EQ(0, std::ranges::count(at_edge(round), 1));

  const std::vector<Surfel> square = jittered_square(32, 7);
  const std::vector<char> edge = at_edge(square);
  std::size_t inside = 0, inside_found = 0, border = 0, border_found = 0;
  for (std::size_t k = 0; k < square.size(); ++k) {
    const bool in = in_the_middle(square[k], 14);  // two rows or more away from the edge
    const bool at = !in_the_middle(square[k], 15.5);
    inside += in;
    inside_found += in && edge[k];
    border += at;
    border_found += at && edge[k];
  }
  EXPECT_LT(inside_found, inside / 100);
  EXPECT_GT(border_found, border * 9 / 10);
}

// Both sides of a plate nearer to each other than its surfels: its rim is an edge all the same.
TEST(Edges, OfAThinPlate) {
  std::vector<Surfel> plate = jittered_square(16, 8);
  const std::size_t one_side = plate.size();
  for (std::size_t k = 0; k < one_side; ++k) {
    Surfel below = plate[k];
    below.position.y -= 0.1f;
    below.normal = -below.normal;
    plate.push_back(below);
  }
  const std::vector<char> edge = at_edge(plate);
  for (std::size_t k = 0; k < one_side; ++k) {
    EXPECT_FALSE(edge[k] && in_the_middle(plate[k], 5)) << k;
    EXPECT_TRUE(edge[k] || in_the_middle(plate[k], 7.8)) << k;
  }
}

// A sheet that faces the other way goes on where the upper one ends.
TEST(Edges, AreNotFilledByWhatFacesAway) {
  std::vector<Surfel> sheets;
  for (Surfel surfel : jittered_square(16, 8)) {
    if (surfel.position.x < 0) sheets.push_back(surfel);
    surfel.position.y -= 0.1f;
    surfel.normal = -surfel.normal;
    sheets.push_back(surfel);
  }
  const std::vector<char> edge = at_edge(sheets);
  int rim = 0, found = 0;
  for (std::size_t k = 0; k < sheets.size(); ++k) {
    const Surfel& surfel = sheets[k];
    if (surfel.normal.y < 0 || surfel.position.x < -0.7f || std::abs(surfel.position.z) > 6) continue;
    ++rim;
    found += edge[k];
  }
  EXPECT_GT(rim, 5);
  EXPECT_GE(found, rim * 8 / 10) << "of " << rim;
}

TEST(Gamma, IsThePapersForASquareGridAndLessWhereMoreSplatsOverlap) {
  Scene plane = parse_scene("", "plane.toml");
  EXPECT_EQ(kPaperGamma, plane.splatting.gamma);
  EXPECT_EQ(0.5, parse_scene("[splatting]\ngamma = 0.5\n", "plane.toml").splatting.gamma);
  EXPECT_EQ(kPaperGamma, suitable_gamma({}, plane.splatting));

  const std::vector<Surfel> surfels = jittered_square(32, 9);
  const double gamma = suitable_gamma(surfels, plane.splatting);
  std::size_t inside = 0, saturated = 0;
  for (const Surfel& surfel : surfels) {
    if (!in_the_middle(surfel, 14)) continue;
    ++inside;
    saturated += gamma * exact_sum(surfels, surfel.position) > 1;
  }
  EXPECT_LT(gamma, 0.6);
  EXPECT_LE(saturated, inside / 50);
  EXPECT_GT(saturated, 0u) << "and not darker than it must be";
}

// Of fewer than a hundred places none may saturate: the larger sum of two decides.
TEST(Gamma, LeavesNoneOfAFewPlacesToSaturate) {
  Splatting splatting = parse_scene("", "plane.toml").splatting;
  splatting.sigma = 0.3;
  const std::vector<Surfel> surfels{{{0, 0, 0}, {0, 0, 1}, 1, {}}, {{0.1f, 0, 0}, {0, 0, 1}, 0.01f, {}}};
  splatting.depth_offset = 0.1;
  const std::vector<double> sums = filter_sums(surfels, splatting, surfels);
  EXPECT_GT(sums[1], 1.5 * sums[0]);
  EXPECT_LT(suitable_gamma(surfels, splatting), 0.8 / sums[0]);
}

// On a square grid 197 splats of radius 2 sqrt(2) overlap, and sum up to 1.960 (by hand: sum of
// exp(-d.d/(4h.h)) over the grid within sqrt(8) sigma h, by 2 pi sigma^2).
TEST(Gamma, CountsAllSplatsThatReachASurfel) {
  const Scene plane =
      parse_scene("[surfels]\ncolumns = 64\nrows = 64\n[splatting]\nsigma = 2\ncutoff = 4\n", "p");
  const std::vector<double> sums = filter_sums(plane.surfels, plane.splatting, plane.surfels);
  constexpr double kAtTheCutoff = 0.003;  // four, which rounding leaves out or not
  EXPECT_NEAR(sums[32 * 64 + 32], 1.960, kAtTheCutoff);
  EXPECT_NEAR(plane.splatting.gamma, 1 / 1.960, kAtTheCutoff)
      << "the sums are nearly the same between surfels";
}

// Sums between surfels are up to 1.4 times those at them, by the cutoff and its shape: no more of the surface
// saturates than is meant to, and where the paper's gamma is not in reach, it is not darker than it must be.
TEST(Gamma, HoldsBetweenSurfelsForAnyCutoff) {
  for (const char* shape : {"true", "false"}) {
    for (const double cutoff : {0.5, 0.95, 1.0, 1.2, 2.0, 4.0}) {
      const Scene plane = parse_scene(fmt::format("[surfels]\ncolumns = 64\nrows = 64\n[splatting]\n"
                                                  "cutoff = {}\ncircular_cutoff = {}\n",
                                                  cutoff, shape),
                                      "p");
      constexpr int kEdge = 40;
      std::vector<Surfel> places(kEdge * kEdge, plane.surfels[0]);  // of one cell of the grid, in the middle
      for (int i = 0; i < kEdge * kEdge; ++i)
        places[static_cast<std::size_t>(i)].position =
            glm::dvec3((i % kEdge + 0.5) / kEdge, 0, (i / kEdge + 0.5) / kEdge);
      std::size_t saturated = 0;
      double largest = 0;
      for (const double sum : filter_sums(plane.surfels, plane.splatting, places)) {
        saturated += plane.splatting.gamma * sum > 1;
        largest = std::max(largest, plane.splatting.gamma * sum);
      }
      EXPECT_LE(saturated, places.size() / 50) << cutoff << ' ' << shape;
      EXPECT_TRUE(plane.splatting.gamma == kPaperGamma || largest > 0.995) << cutoff << ' ' << shape;
    }
  }
}

// A splat reaches surfels that have more than a thousand small ones nearer to them than its centre.
TEST(Gamma, CountsLargeSplatsBeyondManySmallOnes) {
  const Scene plane = parse_scene("[surfels]\ncolumns = 64\nrows = 64\n", "p");
  std::vector<Surfel> surfels = plane.surfels;
  const auto in_the_middle = [&] { return filter_sums(surfels, plane.splatting, surfels)[32 * 64 + 32]; };
  const double small = in_the_middle();
  Surfel large = surfels[0];  // in the corner, 32 sqrt(2) away
  large.radius = 64;
  surfels.push_back(large);
  EXPECT_NEAR(in_the_middle() - small, std::exp(-0.25) / (2 * std::numbers::pi), 1e-6);
}

// A second layer behind a plane is seen with it where z_t reaches it, else not.
TEST(Gamma, CountsWhatIsSeenTogether) {
  const Scene plane = parse_scene("[surfels]\ncolumns = 24\nrows = 24\n", "p");
  const auto in_the_middle = [&](const std::vector<Surfel>& surfels, double depth_offset) {
    Splatting splatting = plane.splatting;
    splatting.depth_offset = depth_offset;
    return filter_sums(surfels, splatting, surfels)[12 * 24 + 12];
  };
  const double one = in_the_middle(plane.surfels, 1);
  std::vector<Surfel> two = plane.surfels;
  for (Surfel surfel : plane.surfels) {
    surfel.position.y -= 1.5f;
    two.push_back(surfel);
  }
  EXPECT_EQ(in_the_middle(two, 1), one);
  EXPECT_DOUBLE_EQ(in_the_middle(two, 2), 2 * one);
}

// In a view along the normal of one surfel another lies 1 / cos as far behind it as its plane does: 0.9
// or 1.5 at 60 degrees. One at right angles shows nothing.
TEST(Gamma, CountsByTheDistanceAlongTheView) {
  Splatting splatting;
  splatting.cutoff = splatting.sigma = splatting.depth_offset = 1;
  const std::vector<Surfel> asked{{{0, 0, 0}, {0, 0, 1}, 1, {}}};
  const auto splats = [&](const glm::vec3& normal, float behind) {
    std::vector<Surfel> both = asked;
    both.push_back({-behind * normal, normal, 1, {}});
    return filter_sums(both, splatting, asked)[0] * 2 * std::numbers::pi;
  };
  const glm::vec3 tilted(std::sqrt(0.75f), 0, 0.5f);
  EXPECT_NEAR(splats(tilted, 0.45f), 2, 1e-6);
  EXPECT_NEAR(splats(tilted, 0.75f), 1, 1e-6);
  EXPECT_NEAR(splats({1, 0, 0}, 0), 1, 1e-6);
}

// In the corner of its square, at 1.3 standard deviations along both axes, a splat cut off at sqrt(2) adds
// exp(-1.69); cut off in a circle it does not reach so far.
TEST(Gamma, CountsTheCornersOfSquareSplats) {
  Splatting splatting;
  splatting.cutoff = splatting.sigma = 1;
  splatting.depth_offset = 0.1;
  const std::vector<Surfel> surfels{{{0, 0, 0}, {0, 0, 1}, 1, {}}},
      asked{{{1.3f, 1.3f, 0}, {0, 0, 1}, 1, {}}};
  EXPECT_NEAR(filter_sums(surfels, splatting, asked)[0] * 2 * std::numbers::pi, std::exp(-1.69), 1e-6);
  splatting.circular_cutoff = true;
  EXPECT_EQ(filter_sums(surfels, splatting, asked)[0], 0);
}

}  // namespace
}  // namespace splatscope::traces
