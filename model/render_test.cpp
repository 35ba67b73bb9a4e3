#include "model/render.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "model/geometry.h"
#include "model/testing/draws.h"
#include "model/testing/random_seed.h"
#include "model/testing/simd_targets.h"

namespace splatscope {
namespace {

using testing::buffer_of;
using testing::listed;

// One triangle over the whole of 4x4 pixels, with NaN in every texture coordinate.
Trace nan_triangle(const std::string& pixel_program) {
  Trace trace;
  trace.width = trace.height = 4;
  trace.buffers = {buffer_of(std::array<float, 9>{-1, -1, 0.5f, -1, 7, 0.5f, 7, -1, 0.5f}),
                   buffer_of(std::array<std::uint16_t, 3>{0, 1, 2})};
  trace.programs = {{"nan.vs", "vs_1_1\nmov oPos, v0\nmov oT0, c0\n"}, {"nan.ps", pixel_program}};
  Draw draw;
  draw.pixel_program = 1;
  draw.vertex_stride = 12;
  draw.attributes = {{0, VertexFormat::float3, 0}};
  draw.index_buffer = 1;
  draw.index_count = 3;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  draw.constants = {{kNan, kNan, kNan, kNan}};
  trace.commands = {Clear{{1, 1, 1, 1}, 1}, draw};
  return trace;
}

// White triangles of the given corners x y z w in clip space, on 16 x 16 pixels.
template <std::size_t kCount>
Trace white_triangles(const std::array<float, kCount>& corners, CullMode cull) {
  std::array<std::uint16_t, kCount / 4> indices;
  std::iota(indices.begin(), indices.end(), std::uint16_t{0});
  Trace trace =
      testing::positions_drawn(16, corners, indices, {"white.vs", "vs_1_1\nmov oPos, v0\nmov oD0, c0\n"});
  Draw& draw = std::get<Draw>(trace.commands[0]);
  draw.constants = {{1, 1, 1, 1}};
  draw.state.cull = cull;
  return trace;
}

TEST(Render, CullModeDropsTheWindingItNames) {
  // Clockwise on the screen, whole and clipped by the near plane into two.
  constexpr std::array<float, 24> kClockwise{-1, -1, 0.5f, 1, -1, 7, 0.5f, 1, 7, -1, 0.5f, 1,
                                             -1, -1, 0.5f, 1, -1, 7, 0.5f, 1, 2, -1, -1,   1};
  const Rendered all = render(white_triangles(kClockwise, CullMode::none), {});
  EXPECT_EQ(all.counters.triangles_back_facing, 0u);
  EXPECT_EQ(all.counters.triangles_clipped, 1u);
  const Rendered kept = render(white_triangles(kClockwise, CullMode::counter_clockwise), {});
  EXPECT_EQ(kept.frame, all.frame);
  EXPECT_EQ(kept.counters.triangles_back_facing, 0u);
  const Rendered dropped = render(white_triangles(kClockwise, CullMode::clockwise), {});
  EXPECT_EQ(dropped.counters.triangles_back_facing, 2u);
  EXPECT_EQ(dropped.counters.fragments, 0u);
  for (const TriangleWork& triangle : dropped.work[0].triangles) {
    EXPECT_EQ(triangle.outcome, TriangleOutcome::back_facing);
    EXPECT_EQ(triangle.pieces, 0);
  }
}

// Every triangle has one winding or none: with one of the modes it is there, with the other it is not.
TEST(Render, TheTwoCullModesShareTheTrianglesBetweenThem) {
  std::mt19937 random(random_seed());
  std::uniform_real_distribution<float> anywhere(-2, 2), w(-0.5f, 1.5f);
  std::array<float, 12 * 500> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = i % 4 == 3 ? w(random) : anywhere(random);
  const RenderCounters all = render(white_triangles(corners, CullMode::none), {}).counters;
  const RenderCounters one = render(white_triangles(corners, CullMode::clockwise), {}).counters;
  const RenderCounters other = render(white_triangles(corners, CullMode::counter_clockwise), {}).counters;
  EXPECT_EQ(one.fragments + other.fragments, all.fragments);
  EXPECT_GT(one.fragments, 0u);
  EXPECT_GT(other.fragments, 0u);
  EXPECT_LE(one.triangles_back_facing + other.triangles_back_facing,
            all.triangles - all.triangles_outside - all.triangles_behind);
}

constexpr std::array<std::uint16_t, 6> kQuad = {0, 1, 2, 0, 2, 3};

// What is shaded is what misses a FIFO of the given length, also where batches of the model end; the picture
// does not depend on it.
void expect_fifo(std::span<const std::uint16_t> indices, std::mt19937& random) {
  std::uniform_real_distribution<float> anywhere(-1, 1);
  static std::array<float, 4 * 3000> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = i % 4 == 3 ? 1 : std::abs(anywhere(random));
  Trace trace = white_triangles(corners, CullMode::none);
  trace.programs[0].text = "vs_1_1\nmov oPos, v0\nmov oD0, v0\n";
  trace.buffers[1] = buffer_of(indices);
  std::get<Draw>(trace.commands[0]).index_count = static_cast<std::uint32_t>(indices.size());
  RenderOptions options;
  const Rendered usual = render(trace, options);
  for (const int entries : {1, 2, 3, 4, 18, 64}) {
    std::deque<std::uint32_t> fifo;
    std::vector<std::uint32_t> shaded;
    for (const std::uint16_t index : indices) {
      if (std::ranges::find(fifo, index) != fifo.end()) continue;
      shaded.push_back(index);
      fifo.push_back(index);
      if (fifo.size() > static_cast<std::size_t>(entries)) fifo.pop_front();
    }
    options.vertex_cache_entries = entries;
    const Rendered rendered = render(trace, options);
    EXPECT_EQ(rendered.work[0].shaded_vertices, shaded) << entries;
    EXPECT_EQ(rendered.counters.vertices, shaded.size());
    EXPECT_EQ(rendered.counters.fragments, usual.counters.fragments);
    EXPECT_EQ(rendered.frame, usual.frame);
  }
}

TEST(Render, ShadesWhatMissesTheVertexCache) {
  std::mt19937 random(random_seed());
  std::array<std::uint16_t, 3 * 2000> indices;  // near one another, moving on; many of them quads
  for (std::size_t i = 0; i < indices.size(); ++i)
    indices[i] = static_cast<std::uint16_t>(i * 2970 / indices.size() + random() % 20);
  for (std::size_t i = 0; i + kQuad.size() < indices.size(); i += 3 * (1 + random() % 4))
    for (std::size_t k = 1; k < kQuad.size(); ++k)
      indices[i + k] = static_cast<std::uint16_t>(indices[i] + kQuad[k]);
  expect_fifo(indices, random);
}

// Nothing but quads, which mostly follow one another, the first of them for one batch of the model or
// several: it takes many of them at once.
TEST(Render, ShadesWhatMissesTheVertexCacheInRunsOfQuads) {
  std::mt19937 random(random_seed());
  constexpr std::uint32_t kBatch = GeometryBatch::kVertices / 4;  // quads
  for (const std::uint32_t first_run : {1u, 100u, kBatch - 1, kBatch, kBatch + 1, 600u}) {
    std::vector<std::uint16_t> indices;
    for (std::uint32_t first = 40, quad = 1; quad < 3000; ++quad) {
      for (const std::uint16_t corner : kQuad) indices.push_back(static_cast<std::uint16_t>(first + corner));
      const std::uint32_t next = (first + 4) % 2996;
      if (quad < first_run) {
        first = next;
      } else if (quad == first_run) {
        first = next - static_cast<std::uint32_t>(random() % 30);  // some of its last ones again
      } else {
        first = random() % 100 == 0 ? static_cast<std::uint32_t>(random() % 2990) : next;
      }
    }
    expect_fifo(indices, random);
  }
}

// So many triangles on three vertices, each cut into two by the near plane, that in one batch the corners of
// the last one would have numbers of more than 16 bits, which would name others.
TEST(Render, ManyTrianglesOnFewVertices) {
  constexpr std::array<float, 12> kCut{-1, -1, 0.5f, 1, -1, 7, 0.5f, 1, 2, -1, -1, 1};
  const Trace once = white_triangles(kCut, CullMode::none);
  Trace often = once;
  std::vector<std::uint16_t> indices;
  constexpr std::uint16_t kTriangles = 10800;
  for (std::uint16_t i = 0; i < 3 * kTriangles; ++i) indices.push_back(i % 3);
  often.buffers[1] = buffer_of(indices);
  auto& draw = std::get<Draw>(often.commands[0]);
  draw.index_count = static_cast<std::uint32_t>(indices.size());
  draw.state.depth_test = false;
  RenderOptions options;
  options.record = Record::nothing;
  const Rendered rendered = render(often, options);
  EXPECT_EQ(rendered.counters.triangles_clipped, kTriangles);
  EXPECT_EQ(rendered.frame.colors8, render(once, options).frame.colors8);
}

// Enough triangles for several batches in flight, on top of one another, with the depth test: small ones,
// whose fragments wait for their turn, and between them so large ones that theirs do not.
Trace many_triangles() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> anywhere(-1, 1);
  constexpr std::size_t kCorner = 4, kTriangle = 3 * kCorner, kTriangles = 6000;
  static std::array<float, kTriangle * kTriangles> corners;
  for (std::size_t triangle = 0; triangle < kTriangles; ++triangle) {
    const float size = triangle / 100 % 3 == 1 ? 1.0f : 0.05f;
    const float x = anywhere(random), y = anywhere(random);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::array<float, kCorner> position{x + size * anywhere(random), y + size * anywhere(random),
                                                std::abs(anywhere(random)), 1};
      std::ranges::copy(position, corners.begin() + kTriangle * triangle + kCorner * corner);
    }
  }
  Trace trace = white_triangles(corners, CullMode::none);
  trace.width = trace.height = 200;
  trace.programs[0].text = "vs_1_1\nmov oPos, v0\nmov oD0, v0\n";
  return trace;
}

Rendered on_threads(const Trace& trace, std::size_t threads, Record record,
                    FrameFormat frame = FrameFormat::unorm8) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
  RenderOptions options;
  options.record = record;
  options.formats.frame = frame;
  return render(trace, options);
}

void expect_same_bits(const Trace& trace, FrameFormat frame) {
  const Rendered one = on_threads(trace, 1, Record::everything, frame);
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const Rendered many = on_threads(trace, threads, Record::everything, frame),
                   frame_alone = on_threads(trace, threads, Record::nothing, frame);
    EXPECT_EQ(one.frame, many.frame);
    EXPECT_EQ(one.frame, frame_alone.frame);
    EXPECT_EQ(one.work[0].shaded_vertices, many.work[0].shaded_vertices);
    EXPECT_EQ(listed(one.work[0].quads), listed(many.work[0].quads));
    EXPECT_EQ(one.counters.fragments_passed, many.counters.fragments_passed);
    EXPECT_EQ(one.counters.fragments_passed, frame_alone.counters.fragments_passed);
  }
}

// Of both forms in which colours wait for their turn.
TEST(Render, AnyNumberOfThreadsGivesTheSameBits) {
  for (const FrameFormat frame : {FrameFormat::unorm8, FrameFormat::float32})
    expect_same_bits(many_triangles(), frame);
}

TEST(Render, EverySimdTargetGivesTheSameBits) {
  const Trace trace = many_triangles();
  std::optional<Rendered> first;
  testing::on_each_simd_target([&] {
    const Rendered rendered = render(trace, {});
    if (!first) first = rendered;
    EXPECT_EQ(first->frame, rendered.frame);
    EXPECT_EQ(listed(first->work[0].quads), listed(rendered.work[0].quads));
  });
}

TEST(Render, SamplesAllOfASmallTraceAndFewRunsOfALargeOne) {
  EXPECT_EQ(sampled_runs_apart(0), 1u);
  EXPECT_EQ(sampled_runs_apart(16383), 1u);
  EXPECT_EQ(sampled_runs_apart(16384), 2u);
  EXPECT_EQ(sampled_runs_apart(262144), 32u);
  EXPECT_EQ(sampled_runs_apart(100'000'000), 32u);
}

// The quads of sampled triangles, and the tiles in which these found all depth clear: {triangle, tile}.
struct Samples {
  std::vector<QuadWork> quads;
  std::set<std::array<std::uint32_t, 2>> clear_tiles;
};

// Of a record of everything. `written`: the tiles with depth, before and after.
Samples samples_of(const DrawWork& all, std::uint32_t width, bool writes, std::set<std::uint32_t>& written) {
  Samples samples;
  const auto tile_of = [&](const QuadWork& quad) { return quad.y / 2u * ((width + 3) / 4) + quad.x / 2u; };
  std::span<const QuadWork> rest = all.quads;
  for (std::uint32_t i = 0; i < all.triangles.size(); ++i) {
    const std::span<const QuadWork> quads = rest.first(all.triangles[i].quad_count);
    rest = rest.subspan(quads.size());
    if (all.is_sampled(i)) samples.quads.insert(samples.quads.end(), quads.begin(), quads.end());
    for (const QuadWork& quad : quads)
      if (all.is_sampled(i) && !written.contains(tile_of(quad)))
        samples.clear_tiles.insert({i, tile_of(quad)});
    for (const QuadWork& quad : quads)
      if (writes && quad.passed != 0) written.insert(tile_of(quad));
  }
  return samples;
}

void expect_samples(const Samples& samples, const DrawWork& work) {
  std::set<std::array<std::uint32_t, 2>> tiles;
  for (const ClearTile& tile : work.clear_tiles) tiles.insert({tile.triangle, tile.tile});
  EXPECT_EQ(tiles, samples.clear_tiles);
  EXPECT_TRUE(std::ranges::is_sorted(work.clear_tiles, {}, &ClearTile::triangle));
  if (!work.samples_only) return;
  EXPECT_EQ(listed(work.quads), listed(samples.quads));
  EXPECT_TRUE(work.shaded_vertices.empty());
}

// As many as if each frame were alone.
TEST(Render, SamplesEachFrameByItsOwnTriangles) {
  Trace trace = many_triangles();
  const Command draw = trace.commands[0];
  trace.commands = {draw, Present{}};
  trace.commands.insert(trace.commands.end(), 6, draw);
  std::vector<std::uint32_t> apart;
  for (const DrawWork& work : render(trace, {}).work) apart.push_back(work.sampled_runs_apart);
  EXPECT_EQ(apart, (std::vector<std::uint32_t>{1, 4, 4, 4, 4, 4, 4}));
}

// Of all triangles there are the counts.
TEST(Render, SamplesOfTheWorkAreThoseOfAllOfIt) {
  Trace trace = many_triangles();
  trace.width = 198;
  trace.height = 201;
  Draw draw = std::get<Draw>(trace.commands[0]);
  trace.commands.assign(6, draw);
  draw.state.depth_write = false;
  trace.commands.insert(trace.commands.begin(), draw);
  const std::vector<DrawWork> all = on_threads(trace, 1, Record::everything).work;
  std::vector<Samples> samples;
  std::set<std::uint32_t> written;
  for (const DrawWork& each : all)
    samples.push_back(samples_of(each, trace.width, each.command != 0, written));
  ASSERT_EQ(all[0].sampled_runs_apart, 4u);
  ASSERT_GT(samples[0].clear_tiles.size(), 500u) << "of 2550 tiles";
  ASSERT_GT(samples[1].clear_tiles.size(), 500u);
  ASSERT_GT(samples[0].quads.size(), 1500u);
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const std::vector<DrawWork> some = on_threads(trace, threads, Record::samples).work;
    for (std::size_t draw = 0; draw < all.size(); ++draw) {
      expect_samples(samples[draw], all[draw]);
      expect_samples(samples[draw], some[draw]);
      EXPECT_TRUE(some[draw].samples_only);
      ASSERT_EQ(some[draw].triangles.size(), all[draw].triangles.size());
      for (std::size_t i = 0; i < all[draw].triangles.size(); ++i)
        ASSERT_EQ(some[draw].triangles[i].quads_passed, all[draw].triangles[i].quads_passed) << i;
    }
  }
}

TEST(Render, EachPresentEndsAFrame) {
  const auto reds = [](const std::vector<Command>& commands) {
    Trace trace;
    trace.width = trace.height = 1;
    trace.commands = commands;
    std::vector<float> seen;
    const Rendered rendered =
        render(trace, {}, {}, [&](const Frame& frame) { seen.push_back(frame.color(0)[0]); });
    EXPECT_EQ(seen.back(), rendered.frame.color(0)[0]);
    return seen;
  };
  const Clear red{{1, 0, 0, 1}, 1};
  EXPECT_EQ(reds({}), std::vector<float>{0});
  EXPECT_EQ(reds({red}), std::vector<float>{1});
  EXPECT_EQ(reds({red, Present{}}), std::vector<float>{1});
  EXPECT_EQ(reds({Present{}, red}), (std::vector<float>{0, 1}));
  EXPECT_EQ(reds({red, Present{}, Present{}, Clear{}, Present{}}), (std::vector<float>{1, 1, 0}));
}

// As a rasteriser walks tiles, so that a wide triangle comes back to no line of a cache that it has left.
TEST(Render, QuadsOfATriangleComeWindowByWindow) {
  Trace trace = white_triangles<12>({-1, 1, 0, 1, 3, 1, 0, 1, -1, -3, 0, 1}, CullMode::none);
  trace.width = trace.height = 64;
  const Rendered rendered = render(trace, {});
  std::vector<std::pair<int, int>> windows;
  for (const QuadWork& quad : rendered.work[0].quads) {
    const std::pair window(quad.y / 4, quad.x / 4);
    if (windows.empty() || windows.back() != window) windows.push_back(window);
  }
  EXPECT_EQ(rendered.work[0].quads.size(), 32u * 32);
  EXPECT_EQ(windows.size(), 8u * 8);
  EXPECT_TRUE(std::ranges::is_sorted(windows));
}

TEST(Render, NanDoesNotReachAFloatFrameBuffer) {
  RenderOptions options;
  options.formats.frame = FrameFormat::float32;
  options.formats.color = ColorFormat::float32;
  for (const std::string program :
       {"ps_1_1\ntexcoord t0\nmov r0, t0\n", "ps_1_1\ntexcoord t0\nmov_sat r0, t0\n"}) {
    const Rendered rendered = render(nan_triangle(program), options);
    ASSERT_EQ(rendered.counters.fragments_passed, 16u);
    for (const Vec4& color : rendered.frame.colors32) EXPECT_EQ(color, (Vec4{0, 0, 0, 1})) << program;
  }
}

// A quarter of a surface is painted twice and composited over a grey frame: render to texture.
TEST(Render, SurfacesAreDrawnIntoAndSampled) {
  Trace trace;
  trace.width = trace.height = 8;
  trace.surfaces = 1;
  // Clip coordinates 1/8 to the upper left: pixels begin at the window's integers.
  trace.buffers = {buffer_of(std::array<float, 12>{-1.125f, 1.125f, 0, 0.875f, 1.125f, 0, -1.125f, -0.875f, 0,
                                                   0.875f, -0.875f, 0}),
                   buffer_of(std::array<std::uint16_t, 6>{0, 1, 2, 2, 1, 3})};
  trace.programs = {{"paint.vs", "vs_1_1\nmov oPos, v0\nmov oD0, c0\n"},
                    {"copy.vs", "vs_1_1\nmov oPos, v0\nmul r0, v0, c1\nadd oT0, r0, c2\n"},
                    {"copy.ps", "ps_1_1\ntex t0\nmov r0, t0\n"}};
  Draw paint;
  paint.target = 1;
  paint.vertex_stride = 12;
  paint.attributes = {{0, VertexFormat::float3, 0}};
  paint.index_buffer = 1;
  paint.index_count = 3;  // the upper left half
  paint.constants = {{0.2f, 0, 0, 0.4f}};
  paint.state = {.depth_test = false, .depth_write = false, .blend = true};
  paint.state.source_factor = paint.state.destination_factor = BlendFactor::one;
  Draw copy = paint;
  copy.target = 0;
  copy.source = 1;
  copy.vertex_program = 1;
  copy.pixel_program = 2;
  copy.index_count = 6;
  copy.constants = {{}, {0.5f, -0.5f, 0, 0}, {0.5625f, 0.5625f, 0, 0}};
  copy.state.destination_factor = BlendFactor::inv_src_alpha;
  trace.commands = {Clear{{0.5f, 0.5f, 0.5f, 1}, 1}, paint, paint, copy};
  for (const FrameFormat format : {FrameFormat::unorm8, FrameFormat::float32}) {
    RenderOptions options;
    options.formats.frame = format;
    const Frame frame = render(trace, options).frame;
    const double tolerance = format == FrameFormat::unorm8 ? 1.5 / 255 : 1e-6;
    for (std::size_t pixel = 0; pixel < 64; ++pixel) {
      const bool painted = pixel / 8 + pixel % 8 < 7;
      if (pixel / 8 + pixel % 8 == 7) continue;  // the diagonal
      EXPECT_NEAR(frame.color(pixel)[0], painted ? 0.4 + 0.2 * 0.5 : 0.5, tolerance) << pixel;
      EXPECT_NEAR(frame.color(pixel)[1], painted ? 0.2 * 0.5 : 0.5, tolerance) << pixel;
    }
  }
}

}  // namespace
}  // namespace splatscope
