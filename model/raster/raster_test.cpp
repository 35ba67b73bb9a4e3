#include "model/raster/raster.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

namespace splatscope::raster {
namespace {

using primitive::Viewport;
using primitive::WindowTriangle;
using primitive::WindowVertex;

constexpr Viewport kViewport{640, 480};

WindowTriangle triangle(double x0, double y0, double x1, double y1, double x2, double y2) {
  WindowTriangle out;
  out[0].x = x0, out[0].y = y0, out[1].x = x1, out[1].y = y1, out[2].x = x2, out[2].y = y2;
  for (WindowVertex& vertex : out) vertex.inverse_w = 1;
  return out;
}

// How often each covered pixel was visited.
std::map<std::pair<int, int>, int> covered(const WindowTriangle& t, int subpixel_bits, double rounding = 0) {
  std::map<std::pair<int, int>, int> pixels;
  for_each_quad(set_up(t, kViewport, subpixel_bits, rounding), [&](int x, int y, unsigned mask) {
    EXPECT_EQ(0, x & 1);
    EXPECT_EQ(0, y & 1);
    for (int bit = 0; bit < 4; ++bit) {
      if (mask >> bit & 1) ++pixels[{x + (bit & 1), y + (bit >> 1)}];
    }
  });
  return pixels;
}

TEST(Raster, CoversWhatTheHardwareCovers) {
  std::ifstream file(SPLATSCOPE_SOURCE "/tests/oracle/window_geometry.json");
  ASSERT_TRUE(file);
  const auto oracle = nlohmann::json::parse(file);
  ASSERT_FALSE(oracle["cases"].empty());
  for (const auto& c : oracle["cases"]) {
    const double left = c["left"], top = c["top"], right = c["right"], bottom = c["bottom"];
    auto pixels = covered(triangle(left, top, right, top, right, bottom), 4);
    for (const auto& [pixel, count] : covered(triangle(left, top, right, bottom, left, bottom), 4)) {
      pixels[pixel] += count;
    }
    const int first_column = c["first_col"], last_column = c["last_col"], first_row = c["first_row"],
              last_row = c["last_row"];
    EXPECT_EQ((std::pair{first_column, first_row}), pixels.begin()->first) << c;
    EXPECT_EQ((std::pair{last_column, last_row}), pixels.rbegin()->first) << c;
    EXPECT_EQ(static_cast<std::size_t>((last_column - first_column + 1) * (last_row - first_row + 1)),
              pixels.size());
    for (const auto& [pixel, count] : pixels) ASSERT_EQ(1, count) << pixel.first << ',' << pixel.second;
  }
}

TEST(Raster, TruncatesToTheSubpixelGrid) {
  EXPECT_EQ(2 * (200 * 16 + 8), snap(200.5624, 4));
  EXPECT_EQ(2 * (200 * 16 + 9), snap(200.5625, 4));
  EXPECT_EQ(-2, snap(-0.01, 4));  // toward minus infinity
  EXPECT_EQ(400, snap(200.99, 0));
}

// Triangles of a fan around an inner point meet without gap and without overlap, on every grid.
TEST(Raster, SharedEdgesAreCoveredOnce) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> inner(8, 24);
  for (int trial = 0; trial < 300; ++trial) {
    const int bits = trial % 9;
    const double x = inner(random), y = inner(random);
    const double corners[][2] = {{2, 2}, {30, 2}, {30, 30}, {2, 30}};
    std::map<std::pair<int, int>, int> pixels;
    for (int i = 0; i < 4; ++i) {
      const auto &a = corners[i], &b = corners[(i + 1) % 4];
      // Either winding covers the same pixels.
      const auto t =
          trial % 2 ? triangle(a[0], a[1], b[0], b[1], x, y) : triangle(b[0], b[1], a[0], a[1], x, y);
      for (const auto& [pixel, count] : covered(t, bits)) pixels[pixel] += count;
    }
    EXPECT_EQ(28u * 28u, pixels.size()) << bits << " bits, " << x << ' ' << y;
    for (const auto& [pixel, count] : pixels) ASSERT_EQ(1, count) << pixel.first << ',' << pixel.second;
  }
}

TEST(Raster, StaysInsideTheViewport) {
  const auto pixels = covered(triangle(-1000, -1000, 3000, -1000, -1000, 3000), 4);
  EXPECT_EQ(std::size_t{kViewport.width} * kViewport.height, pixels.size());
  EXPECT_TRUE(covered(triangle(-10, -10, -1, -10, -10, -1), 4).empty());
  EXPECT_TRUE(covered(triangle(5, 5, 20, 20, 10, 10), 4).empty());  // no area
}

// Coverage equals the sign test in exact arithmetic at every pixel centre.
TEST(Raster, AgreesWithTheEdgeTestAtEveryCentre) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(-8, 40);
  for (int trial = 0; trial < 200; ++trial) {
    const auto t = triangle(anywhere(random), anywhere(random), anywhere(random), anywhere(random),
                            anywhere(random), anywhere(random));
    const auto pixels = covered(t, 8);
    const auto side = [&](int from, int to, double x, double y) {
      const auto grid = [](double v) { return std::floor(v * 256) / 256; };
      const double fx = grid(t[from].x), fy = grid(t[from].y), tx = grid(t[to].x), ty = grid(t[to].y);
      return (tx - fx) * (y - fy) - (ty - fy) * (x - fx);
    };
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) {
        const double s[] = {side(0, 1, x + 0.5, y + 0.5), side(1, 2, x + 0.5, y + 0.5),
                            side(2, 0, x + 0.5, y + 0.5)};
        if (s[0] == 0 || s[1] == 0 || s[2] == 0) continue;  // the fill rule decides: tested above
        const bool inside = (s[0] > 0) == (s[1] > 0) && (s[1] > 0) == (s[2] > 0);
        ASSERT_EQ(inside, pixels.contains({x, y})) << x << ',' << y;
      }
    }
  }
}

TEST(Raster, PlanesInterpolatePerspectiveCorrectly) {
  WindowTriangle t = triangle(10, 10, 90, 20, 30, 100);
  t[0].inverse_w = 1, t[1].inverse_w = 0.25, t[2].inverse_w = 0.5;
  t[0].z = 0, t[1].z = 0.75, t[2].z = 0.5;
  const TriangleSetup setup = set_up(t, kViewport, 4, driver_rounding(4));
  ASSERT_TRUE(setup.covers);
  // At window barycentrics (l0, l1, l2) the perspective ones are li/wi over their sum.
  const double l[] = {0.2, 0.5, 0.3};
  double x = 0, y = 0, z = 0, sum = 0;
  for (int i = 0; i < 3; ++i)
    x += l[i] * t[i].x, y += l[i] * t[i].y, z += l[i] * t[i].z, sum += l[i] * t[i].inverse_w;
  const auto dx = static_cast<float>(x - (setup.left + 0.5)), dy = static_cast<float>(y - (setup.top + 0.5));
  const float scale = setup.scale.at(dx, dy);
  EXPECT_NEAR(l[1] * 0.25 / sum, setup.weight1.at(dx, dy) / scale, 1e-6);
  EXPECT_NEAR(l[2] * 0.5 / sum, setup.weight2.at(dx, dy) / scale, 1e-6);
  EXPECT_NEAR(z, setup.depth.at(dx, dy), 1e-6);
}

TEST(Raster, WindingIsThatOfTheSnappedCorners) {
  EXPECT_EQ(1, winding(triangle(10, 10, 20, 10, 10, 20), 4, 0));  // clockwise, y down
  EXPECT_EQ(-1, winding(triangle(10, 10, 10, 20, 20, 10), 4, 0));
  EXPECT_EQ(0, winding(triangle(5, 5, 20, 20, 10, 10), 4, 0));
  // Clockwise by less than a step of a coarse grid: snapped to the other way round, or to nothing.
  EXPECT_EQ(1, winding(triangle(0, 0, 20, 10.9, 10, 5.46), 8, 0));
  EXPECT_EQ(-1, winding(triangle(0, 0, 20, 10.9, 10, 5.46), 0, 0.5));
  EXPECT_EQ(0, winding(triangle(0, 0, 20, 10.9, 10, 5.46), 0, 0));
}

TEST(Raster, CountsTiles) {
  EXPECT_EQ(1u, tiles_touched(set_up(triangle(1, 1, 7, 1, 1, 7), kViewport, 4, 0)));
  EXPECT_EQ(4u, tiles_touched(set_up(triangle(1, 1, 12, 1, 1, 12), kViewport, 4, 0)));
}

}  // namespace
}  // namespace splatscope::raster
