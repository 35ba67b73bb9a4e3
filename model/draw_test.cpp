#include "model/draw.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "model/testing/draws.h"
#include "model/testing/random_seed.h"

namespace splatscope {
namespace {

constexpr std::uint32_t kFrameSize = 64, kVertices = 600;

using testing::buffer_of;
using testing::listed;

// Triangles all over the frame, a position and a colour a vertex, and what draws of different kinds bind.
Trace without_draws(std::mt19937& random) {
  std::uniform_real_distribution<float> anywhere(-1, 1);
  Trace trace;
  trace.width = trace.height = kFrameSize;
  trace.surfaces = 2;
  std::vector<float> vertices;
  for (std::uint32_t i = 0; i < kVertices; ++i)
    for (const float value : {anywhere(random), anywhere(random), (anywhere(random) + 1) / 2, 1.0f,
                              anywhere(random), anywhere(random), anywhere(random), anywhere(random)})
      vertices.push_back(value);
  std::vector<std::uint16_t> indices;
  for (std::uint32_t i = 0; i < 3 * kVertices; ++i)
    indices.push_back(static_cast<std::uint16_t>(random() % kVertices));
  trace.buffers = {buffer_of(vertices), buffer_of(indices)};
  Texture texture{8, 8, {}};
  for (int i = 0; i < 64; ++i) texture.texels.push_back(static_cast<std::uint8_t>(random() % 256));
  trace.textures = {texture};
  trace.programs = {{"colored.vs", "vs_1_1\nmov oPos, v0\nmov oD0, v1\nmov oT0, v1\n"},
                    {"constant.vs", "vs_1_1\nmov oPos, v0\nrcp r0, c1.x\nmin oD0, r0, c0\nmov oT0, v0\n"},
                    {"texture.ps", "ps_1_1\ntex t0\nadd r0, t0, v0\n"},
                    {"coordinates.ps", "ps_1_1\ntexcoord t0\nmul r0, t0, v0\n"}};
  return trace;
}

// Of up to 200 triangles, or of none.
Draw any_draw(std::mt19937& random) {
  const auto one_in = [&](std::uint32_t n) { return random() % n == 0; };
  Draw draw;
  draw.vertex_program = static_cast<std::uint32_t>(random() % 2);
  if (!one_in(4)) draw.pixel_program = 2 + static_cast<std::uint32_t>(random() % 2);
  draw.target = one_in(4) ? static_cast<std::uint32_t>(1 + random() % 2) : 0;
  if (draw.pixel_program == 2u && one_in(3)) draw.source = draw.target == 1 ? 2 : 1;
  if (draw.pixel_program && !draw.source) draw.texture = 0;
  draw.vertex_stride = 32;
  draw.attributes = {{0, VertexFormat::float4, 0}};
  if (one_in(2)) draw.attributes.push_back({1, VertexFormat::float4, 16});
  draw.index_buffer = 1;
  draw.index_count = one_in(8) ? 0 : 3 * static_cast<std::uint32_t>(1 + random() % 200);
  draw.first_index = static_cast<std::uint32_t>(random() % (3 * kVertices - draw.index_count));
  // Often those of the draw before, or nearly so.
  draw.constants = {{one_in(2) ? 1.0f : 0.5f, 0.25f, 0.75f, 0.5f}, {one_in(2) ? 0.0f : -0.0f}};
  const bool depth = draw.target == 0 && one_in(2);
  draw.state = {depth,     depth && one_in(2),     !depth || !one_in(4),
                one_in(2), BlendFactor::src_alpha, BlendFactor::one};
  return draw;
}

struct Seen {
  Rendered rendered;
  std::vector<DrawWork> work;  // as it came
};

Seen render_on(const Trace& trace, std::size_t threads, Record record) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
  RenderOptions options;
  options.record = record;
  std::vector<DrawWork> work;
  Rendered rendered = render(trace, options, {}, {}, [&](DrawWork draw) { work.push_back(std::move(draw)); });
  return {std::move(rendered), std::move(work)};
}

// What timing looks at.
void expect_same_work(const DrawWork& a, const DrawWork& b) {
  EXPECT_EQ(a.shaded_vertices, b.shaded_vertices);
  EXPECT_EQ(a.texel_blocks, b.texel_blocks);
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    EXPECT_EQ(a.triangles[i].quad_count, b.triangles[i].quad_count);
    EXPECT_EQ(a.triangles[i].quads_passed, b.triangles[i].quads_passed);
    EXPECT_EQ(a.triangles[i].outcome, b.triangles[i].outcome);
  }
  EXPECT_EQ(listed(a.quads), listed(b.quads));
  ASSERT_EQ(a.clear_tiles.size(), b.clear_tiles.size());
  for (std::size_t i = 0; i < a.clear_tiles.size(); ++i) {
    EXPECT_EQ(a.clear_tiles[i].triangle, b.clear_tiles[i].triangle);
    EXPECT_EQ(a.clear_tiles[i].tile, b.clear_tiles[i].tile);
  }
}

void expect_same(const Seen& alone, const Seen& together, bool recorded) {
  EXPECT_EQ(alone.rendered.frame, together.rendered.frame);
  EXPECT_EQ(alone.rendered.counters.vertices, together.rendered.counters.vertices);
  EXPECT_EQ(alone.rendered.counters.fragments_passed, together.rendered.counters.fragments_passed);
  ASSERT_EQ(together.work.size(), recorded ? alone.work.size() : 0);
  for (std::size_t i = 0; i < together.work.size(); ++i) {
    EXPECT_EQ(alone.work[i].command, 2 * i);
    EXPECT_EQ(together.work[i].command, i);
    expect_same_work(alone.work[i], together.work[i]);
  }
}

// Draws that follow one another are in flight together; behind a Present each one is alone.
TEST(DrawPipeline, DrawsInFlightTogetherDrawWhatEachDrawsAlone) {
  std::mt19937 random(random_seed());
  for (int round = 0; round < 10; ++round) {
    Trace together = without_draws(random), alone = together;
    for (int i = 0; i < 40; ++i) {
      const Draw draw = any_draw(random);
      together.commands.emplace_back(draw);
      alone.commands.emplace_back(draw);
      alone.commands.emplace_back(Present{});
    }
    for (const Record record : {Record::everything, Record::nothing}) {
      const Seen expected = render_on(alone, 1, record);
      for (const std::size_t threads : {1u, 2u, 4u})
        expect_same(expected, render_on(together, threads, record), record == Record::everything);
    }
  }
}

// Put together, parts are what the draw did; none is much larger than one of its triangles, however many
// these are.
TEST(DrawPipeline, PartsOfADrawAreFewOfItsTriangles) {
  const Trace trace = testing::rectangles(256, 40);
  const Rendered whole = render(trace, {});
  ASSERT_EQ(whole.work.size(), 1u);
  ASSERT_EQ(whole.work[0].quads.size(), 40u * (128 * 128 + 128));  // those of the diagonal twice
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    DrawWork all;
    std::size_t most = 0;
    const Rendered rendered = render_in_parts(trace, {}, {}, {}, [&](DrawWork& part) {
      most = std::max(most, part.quads.size());
      all.append(part);
    });
    expect_same_work(whole.work[0], all);
    EXPECT_EQ(rendered.frame, whole.frame);
    EXPECT_LT(most, 2u * 128 * 128);
  }
}

}  // namespace
}  // namespace splatscope
