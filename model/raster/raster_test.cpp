#include "model/raster/raster.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <tuple>

#include "model/output/output.h"
#include "model/testing/oracle.h"
#include "model/testing/random_seed.h"
#include "model/testing/simd_targets.h"

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

TriangleSetup set_up(const WindowTriangle& t, int subpixel_bits, double rounding) {
  const auto corners = std::make_unique<Corners>();
  for (std::size_t i = 0; i < 3; ++i) corners->set(0, i, t[i].x, t[i].y, t[i].z, t[i].inverse_w);
  TriangleSetup setup;
  raster::set_up(*corners, {kViewport, subpixel_bits, rounding}, std::span(&setup, 1));
  return setup;
}

// All windows of a triangle with covered pixels.
std::vector<Window> windows_of(const TriangleSetup& setup, const DepthTarget& depth) {
  std::vector<Window> all;
  const auto band = std::make_unique<std::array<Window, kMaxWindows>>();
  if (!setup.covers) return all;
  for (int y = setup.top & ~1; y < setup.bottom; y += kWindow) {
    const BandCounts counts = rasterize_band(setup, depth, y, *band);
    BandCounts expected{counts.windows, 0, 0, 0, 0};
    for (const Window& window : std::span(*band).first(counts.windows)) {
      expected.covered += static_cast<unsigned>(std::popcount(window.covered));
      expected.passed += static_cast<unsigned>(std::popcount(window.passed));
      for (unsigned quad = 0; quad < 16; ++quad) {
        expected.quads += (window.covered >> 4 * quad & 15u) != 0;
        expected.quads_passed += (window.passed >> 4 * quad & 15u) != 0;
      }
      all.push_back(window);
    }
    EXPECT_EQ(std::tuple(expected.covered, expected.passed, expected.quads, expected.quads_passed),
              std::tuple(counts.covered, counts.passed, counts.quads, counts.quads_passed));
  }
  return all;
}

DepthTarget no_depth() {
  return {{}, kViewport, DepthFormat::z24, false, false};
}

// How often each covered pixel was visited.
std::map<std::pair<int, int>, int> covered(const WindowTriangle& t, int subpixel_bits, double rounding = 0) {
  std::map<std::pair<int, int>, int> pixels;
  for (const Window& window : windows_of(set_up(t, subpixel_bits, rounding), no_depth())) {
    EXPECT_EQ(0, window.x & 1);
    EXPECT_EQ(0, window.y & 1);
    EXPECT_EQ(window.covered, window.passed);
    for (unsigned bit = 0; bit < 64; ++bit)
      if (window.covered >> bit & 1) ++pixels[{window.x + Window::x_of(bit), window.y + Window::y_of(bit)}];
  }
  return pixels;
}

TEST(Raster, CoversWhatTheHardwareCovers) {
  const nlohmann::json vectors = oracle("window_geometry.json");
  ASSERT_FALSE(vectors["cases"].empty());
  for (const auto& c : vectors["cases"]) {
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

// Triangles of a fan around an inner point meet without gap and without overlap, on every grid.
TEST(Raster, SharedEdgesAreCoveredOnce) {
  std::mt19937 random(random_seed());
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
  std::mt19937 random(random_seed());
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
  const TriangleSetup setup = set_up(t, 4, driver_rounding(4));
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

int winding_of(const WindowTriangle& t, int subpixel_bits, double rounding) {
  return set_up(t, subpixel_bits, rounding).winding;
}

TEST(Raster, WindingIsThatOfTheSnappedCorners) {
  EXPECT_EQ(1, winding_of(triangle(10, 10, 20, 10, 10, 20), 4, 0));  // clockwise, y down
  EXPECT_EQ(-1, winding_of(triangle(10, 10, 10, 20, 20, 10), 4, 0));
  EXPECT_EQ(0, winding_of(triangle(5, 5, 20, 20, 10, 10), 4, 0));
  // Clockwise by less than a step of a coarse grid: snapped to the other way round, or to nothing.
  EXPECT_EQ(1, winding_of(triangle(0, 0, 20, 10.9, 10, 5.46), 8, 0));
  EXPECT_EQ(-1, winding_of(triangle(0, 0, 20, 10.9, 10, 5.46), 0, 0.5));
  EXPECT_EQ(0, winding_of(triangle(0, 0, 20, 10.9, 10, 5.46), 0, 0));
}

bool same(const Plane& a, const Plane& b) {
  return std::memcmp(&a, &b, sizeof(Plane)) == 0;
}

void expect_same(const TriangleSetup& a, const TriangleSetup& b) {
  ASSERT_EQ(a.covers, b.covers);
  ASSERT_EQ(a.winding, b.winding);
  if (!a.covers) return;
  for (std::size_t e = 0; e < 3; ++e)
    ASSERT_EQ(std::tuple(a.edges[e].origin, a.edges[e].dx, a.edges[e].dy),
              std::tuple(b.edges[e].origin, b.edges[e].dx, b.edges[e].dy));
  ASSERT_EQ(std::tuple(a.left, a.top, a.right, a.bottom), std::tuple(b.left, b.top, b.right, b.bottom));
  ASSERT_EQ(std::tuple(a.nearest, a.furthest), std::tuple(b.nearest, b.furthest));
  ASSERT_TRUE(same(a.depth, b.depth) && same(a.weight1, b.weight1) && same(a.weight2, b.weight2) &&
              same(a.scale, b.scale));
}

// Every SIMD target gives the setups, the coverage and the depths of the first one, which has no SIMD.
TEST(Raster, EverySimdTargetGivesTheSameBits) {
  std::mt19937 random(random_seed());
  std::uniform_real_distribution<double> size(-12, 12), z(-0.1, 1.1), w(0.01, 1), anywhere(-1, 1);
  std::vector<WindowTriangle> triangles;
  for (int i = 0; i < 400; ++i) {
    const double reach = i % 20 == 0 ? 30000 : 1;  // a few as large as the guard band lets them be
    const double x = 320 + 340 * anywhere(random), y = 240 + 260 * anywhere(random);
    WindowTriangle t =
        triangle(x + reach * size(random) / 12, y + reach * size(random) / 12, x + size(random),
                 y + size(random), x + reach * size(random) / 12, y + size(random));
    if (i % 10 == 5) t[1].y = t[0].y, t[2].y = t[0].y + (i % 20 == 5 ? 1e-6 : 1e-30);  // slivers
    for (WindowVertex& vertex : t) vertex.z = z(random), vertex.inverse_w = w(random);
    triangles.push_back(t);
  }
  struct Drawn {
    std::vector<TriangleSetup> setups;
    std::vector<Window> windows;
    std::vector<std::uint32_t> depth;
  };
  for (const DepthFormat format : {DepthFormat::z16, DepthFormat::z24, DepthFormat::float32}) {
    std::optional<Drawn> first;
    testing::on_each_simd_target([&] {
      Drawn drawn;
      drawn.depth.assign(std::size_t{kViewport.width} * kViewport.height,
                         output::quantize_depth(0.9f, format));
      for (const WindowTriangle& t : triangles) {
        TriangleSetup setup = set_up(t, 4, driver_rounding(4));
        const std::size_t number = drawn.setups.size();
        drawn.setups.push_back(setup);
        // What a plane beside its corners can say: no number, or a zero with a sign.
        if (number % 16 == 3) setup.depth.dx = std::numeric_limits<float>::quiet_NaN();
        if (number % 16 == 7) setup.depth = {-0.0f, -0.0f, -0.0f}, setup.nearest = 0;
        for (const Window& window : windows_of(setup, {drawn.depth, kViewport, format, true, true}))
          drawn.windows.push_back(window);
      }
      if (!first) first = drawn;
      for (std::size_t i = 0; i < triangles.size(); ++i)
        ASSERT_NO_FATAL_FAILURE(expect_same(first->setups[i], drawn.setups[i]));
      ASSERT_EQ(first->windows.size(), drawn.windows.size());
      for (std::size_t i = 0; i < drawn.windows.size(); ++i) {
        const Window &a = first->windows[i], &b = drawn.windows[i];
        ASSERT_EQ(std::tuple(a.x, a.y, a.covered, a.passed), std::tuple(b.x, b.y, b.covered, b.passed));
      }
      ASSERT_EQ(first->depth, drawn.depth);
    });
  }
}

// Quads in which any corner can be anywhere, also none of whose triangles covers a pixel, from any number of
// them that fit into Corners.
TEST(Raster, QuadsAreSetUpAsTheirTriangles) {
  std::mt19937 random(random_seed());
  std::uniform_real_distribution<double> anywhere(-20, 660), offset(-12, 12), z(-0.1, 1.1), w(0.01, 1);
  constexpr std::size_t kFirst = kQuadVertices, kMost = Corners::kCapacity / 2;
  primitive::ProjectedVertices vertices;
  for (auto* values : {&vertices.x, &vertices.y, &vertices.z, &vertices.inverse_w})
    values->resize(kFirst + 4 * kMost);
  for (std::size_t quads = 1; quads <= kMost; ++quads) {
    const auto corners = std::make_unique<Corners>();
    for (std::size_t quad = 0; quad < quads; ++quad) {
      const double x = anywhere(random), y = anywhere(random);
      for (std::size_t i = kFirst + 4 * quad; i < kFirst + 4 * quad + 4; ++i) {
        vertices.x[i] = x + offset(random), vertices.y[i] = y + offset(random);
        vertices.z[i] = z(random), vertices.inverse_w[i] = w(random);
      }
      for (std::size_t triangle = 0; triangle < 2; ++triangle)
        for (std::size_t corner = 0; corner < 3; ++corner) {
          const std::size_t i = kFirst + 4 * quad + (corner == 0 ? 0 : corner + triangle);
          corners->set(2 * quad + triangle, corner, vertices.x[i], vertices.y[i], vertices.z[i],
                       vertices.inverse_w[i]);
        }
    }
    const int bits = static_cast<int>(quads % 9);
    const SetupOptions options{kViewport, bits, driver_rounding(bits), quads % 3 != 0};
    testing::on_each_simd_target([&] {
      std::vector<TriangleSetup> alone(2 * quads), together(2 * quads);
      raster::set_up(*corners, options, alone);
      set_up_quads(vertices, kFirst, options, together);
      for (std::size_t i = 0; i < 2 * quads; ++i) ASSERT_NO_FATAL_FAILURE(expect_same(alone[i], together[i]));
    });
  }
}

TEST(Raster, DepthTestKeepsTheNearest) {
  std::vector<std::uint32_t> depth(std::size_t{kViewport.width} * kViewport.height,
                                   output::quantize_depth(0.5f, DepthFormat::z24));
  const auto passed = [&](double z, bool test, bool write) {
    WindowTriangle t = triangle(2, 2, 3, 2, 2, 3);  // the pixel (2, 2)
    for (WindowVertex& vertex : t) vertex.z = z;
    const auto windows = windows_of(set_up(t, 4, 0.1), {depth, kViewport, DepthFormat::z24, test, write});
    EXPECT_EQ(1u, windows.size());
    return windows.at(0).passed != 0;
  };
  const std::uint32_t& stored = depth[2 * kViewport.width + 2];
  EXPECT_TRUE(passed(0.5, true, true));  // less or equal
  EXPECT_FALSE(passed(0.5001, true, true));
  EXPECT_TRUE(passed(0.25, true, false));
  EXPECT_EQ(output::quantize_depth(0.5f, DepthFormat::z24), stored);
  EXPECT_TRUE(passed(0.25, true, true));
  EXPECT_EQ(output::quantize_depth(0.25f, DepthFormat::z24), stored);
  EXPECT_TRUE(passed(0.75, false, true));
  EXPECT_EQ(output::quantize_depth(0.75f, DepthFormat::z24), stored);
}

// The grid makes a sliver 1/16 pixel high, so that it covers the centres of pixels 1/32 pixel beside it: more
// than a thousand times its height.
TEST(Raster, DepthOfASliverStaysWithinThatOfItsCorners) {
  std::vector<std::uint32_t> depth(std::size_t{kViewport.width} * kViewport.height,
                                   output::quantize_depth(1, DepthFormat::z24));
  const double rounds_here = 2.5 + 0.5 / 16;  // from the row of centres to the next step of the grid
  WindowTriangle t = triangle(1, rounds_here - 1e-5, 9, rounds_here - 1e-5, 5, rounds_here + 1e-5);
  t[0].z = t[1].z = 0.5, t[2].z = 0.51;
  windows_of(set_up(t, 4, driver_rounding(4)), {depth, kViewport, DepthFormat::z24, true, true});
  EXPECT_EQ(output::quantize_depth(0.5f, DepthFormat::z24), depth[2 * kViewport.width + 5]);
}

TEST(Raster, CountsTiles) {
  EXPECT_EQ(1u, tiles_touched(set_up(triangle(1, 1, 7, 1, 1, 7), 4, 0)));
  EXPECT_EQ(4u, tiles_touched(set_up(triangle(1, 1, 12, 1, 1, 12), 4, 0)));
}

}  // namespace
}  // namespace splatscope::raster
