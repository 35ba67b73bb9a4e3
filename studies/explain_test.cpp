#include "studies/explain.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "model/error.h"
#include "model/render.h"
#include "traces/recorder.h"
#include "traces/volume_trace.h"
#include "traces/volumes/volume_scene.h"

namespace splatscope::studies {
namespace {

Trace small_trace(const std::string& algorithm) {
  const traces::Scene scene = traces::parse_scene(
      "surfels = { columns = 24, rows = 20 }\nframe = { width = 64, height = 48 }\ncapture.views = 1\n"
      "camera = { eye = [0, 14, -20], target = [0, 0, 0] }\nsplatting.algorithm = \"" +
          algorithm + "\"\n",
      "small.toml");
  return traces::record(scene, NumberFormats{}).trace;
}

// Whatever the pixel: its last step leaves what the frame holds, and the steps tell of all its fragments.
TEST(Explain, StepsEndInTheFrame) {
  for (const char* algorithm : {"ewa-per-surfel", "ewa-per-pixel"}) {
    const Trace trace = small_trace(algorithm);
    const Rendered rendered = render(trace, {});
    std::size_t triangles = 0;
    for (const auto& [x, y] : {std::pair{32u, 24u}, {20u, 30u}, {63u, 47u}, {0u, 0u}, {33u, 25u}}) {
      const std::vector<PixelStep> steps = explain_pixel(trace, {}, x, y);
      const std::size_t pixel = y * 64 + x;
      EXPECT_EQ(rendered.frame.color(pixel), steps.back().after) << algorithm << " " << x << "," << y;
      EXPECT_EQ(rendered.frame.depth_value(pixel), steps.back().depth);
      for (const PixelStep& step : steps) triangles += step.kind == PixelStep::Kind::triangle;
    }
    EXPECT_GT(triangles, 20u);
  }
}

TEST(Explain, SaysWhereNoTriangleCoversThePixel) {
  const Trace trace = small_trace("ewa-per-surfel");
  const auto text_of = [&](std::uint32_t x, std::uint32_t y) {
    return describe(trace, NumberFormats{}, explain_pixel(trace, {}, x, y));
  };
  EXPECT_TRUE(text_of(0, 0).ends_with("\nno triangle covers the pixel\n")) << text_of(0, 0);
  EXPECT_EQ(text_of(32, 24).find("no triangle"), std::string::npos);
}

TEST(Explain, SaysWhatTheHostDoes) {
  const Trace trace = small_trace("ewa-per-pixel");
  const std::string text = describe(trace, NumberFormats{}, explain_pixel(trace, {}, 32, 24));
  EXPECT_NE(text.find("normalise on the host"), std::string::npos) << text;
  EXPECT_EQ(text.find("present"), std::string::npos) << text;
}

// Per surfel: out = source * source alpha + before, in double exactly, in 8 bits rounded once.
TEST(Explain, EachStepAddsItsSource) {
  const Trace trace = small_trace("ewa-per-surfel");
  const std::vector<PixelStep> steps = explain_pixel(trace, {}, 32, 24);
  std::size_t added = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i - 1].after, steps[i].before);
    EXPECT_EQ(steps[i - 1].after_in_double, steps[i].before_in_double);
    if (!steps[i].passed || !steps[i].writes_color) continue;
    ++added;
    EXPECT_NEAR(steps[i].diffuse[3] * steps[i].texel[3], steps[i].source[3], 1.5 / 255) << "9-bit combiners";
    for (std::size_t c = 0; c < 3; ++c) {
      const double source = steps[i].source[c], alpha = steps[i].source[3];
      EXPECT_EQ(source * alpha + steps[i].before_in_double[c], steps[i].after_in_double[c]);
      // Half a step of rounding, and half a step of the source, which enters with less than its own weight.
      EXPECT_NEAR(std::min(source * alpha + steps[i].before[c], 1.0), steps[i].after[c], 1.01 / 255);
    }
  }
  EXPECT_GT(added, 3u);
  const std::string text = describe(trace, {}, steps);
  EXPECT_NE(std::string::npos, text.find("depth test passed"));
  EXPECT_NE(std::string::npos, text.find("in 8 bits, of 255: "));
  EXPECT_NE(std::string::npos, text.find("in double: "));
}

// A frame buffer of binary32 is as good as exact: what the steps say in double is what it shows, also after
// the division on the host.
TEST(Explain, DoubleIsWhatAFloatFrameNearlyHolds) {
  NumberFormats formats;
  formats.frame = FrameFormat::float32;
  for (const char* algorithm : {"ewa-per-surfel", "ewa-per-pixel"}) {
    const Trace trace = small_trace(algorithm);
    const std::vector<PixelStep> steps = explain_pixel(trace, formats, 32, 24);
    for (const PixelStep& step : steps) {
      for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(step.after_in_double[c], step.after[c], 1e-5) << "tens of sums";
    }
    EXPECT_GT(steps.back().after_in_double[3], 0.01) << "something was drawn";
  }
}

// What the pixel unit reads is shown before its combiners round it to 1/255: a colour of 12 bits here.
TEST(Explain, TheCombinersDoNotRoundWhatIsShownOfTheirInputs) {
  NumberFormats formats;
  formats.color = ColorFormat::unorm12;
  formats.combiner = CombinerFormat::signed9;
  bool is_finer = false;
  for (const PixelStep& step : explain_pixel(small_trace("ewa-per-surfel"), formats, 32, 24)) {
    for (const float channel : step.diffuse) {
      EXPECT_NEAR(4095 * channel, std::round(4095 * channel), 1e-3);
      is_finer |= std::abs(255 * channel - std::round(255 * channel)) > 0.05f;
    }
  }
  EXPECT_TRUE(is_finer);
}

Trace small_volume_trace() {
  const char* const text =
      "[volume]\ngenerator = \"head\"\nvoxels = [4, 4, 3]\n[frame]\nwidth = 16\nheight = 16\n";
  return traces::record(traces::parse_volume_scene(text, "head.toml")).trace;
}

// A sheet is summed up in a surface, then drawn over the frame: each is followed by itself.
TEST(Explain, SurfacesAreApartFromTheFrame) {
  const Trace trace = small_volume_trace();
  for (const FrameFormat format : {FrameFormat::unorm8, FrameFormat::float32}) {
    NumberFormats formats;
    formats.frame = format;
    const std::vector<PixelStep> steps = explain_pixel(trace, formats, 8, 8);
    std::array<PixelStep, 2> last{};  // of the frame and of the surface
    std::size_t composites = 0;
    for (const PixelStep& step : steps) {
      ASSERT_LE(step.target, 1u);
      EXPECT_EQ(last[step.target].after, step.before);
      EXPECT_EQ(last[step.target].after_in_double, step.before_in_double);
      last[step.target] = step;
      composites += step.target == 0 && step.kind == PixelStep::Kind::triangle;
      // In 8 bits every splat and every composite is rounded once, and its source before it.
      const double rounding = format == FrameFormat::unorm8 ? 4.0 / 255 : 1e-6;
      for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(step.after_in_double[c], step.after[c], rounding);
    }
    EXPECT_GT(composites, 2u) << "sheets";
    EXPECT_GT(last[0].after_in_double[3], 0.1) << "something was drawn";
    RenderOptions options;
    options.formats = formats;
    EXPECT_EQ(render(trace, options).frame.color(8 * 16 + 8), last[0].after);
    const std::string text = describe(trace, formats, steps);
    EXPECT_NE(std::string::npos, text.find("by voxel_grid.vs, into surface 1\n"));
    EXPECT_NE(std::string::npos, text.find("by sheet.vs, from surface 1\n"));
  }
}

// A surface that is made from another, which is made anew from the first.
TEST(Explain, SurfacesAreMadeFromEachOther) {
  Trace trace = small_volume_trace();
  std::vector<Draw> fills, copies;
  for (const Command& command : trace.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (!draw) continue;
    if (draw->source) copies.push_back(*draw);
    if (!draw->source && !draw->texture && draw->target == 1 && !draw->state.blend) fills.push_back(*draw);
  }
  ASSERT_FALSE(fills.empty());
  ASSERT_FALSE(copies.empty());
  Draw fill = fills[0], copy = copies[0];
  fill.constants = {{0.8f, 0.6f, 0.4f, 1}};
  copy.constants = {{0.5f, 0.5f, 0.5f, 0.5f}};
  copy.state.blend = false;
  const auto copied = [&](std::uint32_t from, std::uint32_t to) {
    Draw draw = copy;
    draw.source = from;
    draw.target = to;
    return draw;
  };
  trace.surfaces = 2;
  trace.commands = {Clear{}, fill, copied(1, 2), copied(2, 1), copied(1, 0)};
  const std::vector<PixelStep> steps = explain_pixel(trace, {}, 8, 8);
  ASSERT_EQ(5u, steps.size());
  EXPECT_EQ(std::string::npos, describe(trace, {}, {steps[1]}).find("texel")) << "a fill has none";
  const double scale[] = {0, 1, 0.5, 0.25, 0.125};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_NEAR(0.8 * scale[i], steps[i].after[0], 1.5 / 255) << i;
    EXPECT_NEAR(0.4 * scale[i], steps[i].after_in_double[2], 1.5 / 255) << i;
  }
}

// A surface that is sampled elsewhere than at the pixel itself: what lies there was drawn past the pixel.
TEST(Explain, SurfacesAreSampledAnywhere) {
  Trace trace = small_volume_trace();
  for (Command& command : trace.commands) {
    auto* draw = std::get_if<Draw>(&command);
    if (!draw || !draw->source) continue;
    Buffer shifted = trace.buffers[draw->vertex_buffer];
    const auto coordinate =
        std::ranges::find(draw->attributes, VertexFormat::float2, &VertexAttribute::format);
    ASSERT_NE(coordinate, draw->attributes.end());
    for (std::size_t at = coordinate->offset; at < shifted.bytes.size(); at += draw->vertex_stride) {
      float u = 0;
      std::memcpy(&u, &shifted.bytes[at], sizeof u);
      u += 3.0f / 16;  // three pixels
      std::memcpy(&shifted.bytes[at], &u, sizeof u);
    }
    draw->vertex_buffer = static_cast<std::uint32_t>(trace.buffers.size());
    trace.buffers.push_back(std::move(shifted));
  }
  const Frame frame = render(trace, {}).frame;
  for (std::uint32_t x = 2; x < 14; x += 3) {
    const std::vector<PixelStep> steps = explain_pixel(trace, {}, x, 8);
    const auto last = std::ranges::find(steps.rbegin(), steps.rend(), 0u, &PixelStep::target);
    EXPECT_EQ(frame.color(8 * 16 + x), last->after) << x;
  }
  EXPECT_GT(frame.color(8 * 16 + 5)[3], 0) << "something was drawn";
}

TEST(Explain, VertexProgramsAreTold) {
  const Trace trace = small_trace("ewa-per-surfel");
  const std::string text = explain_vertex(trace, {}, 1, 5);
  EXPECT_NE(std::string::npos, text.find("vertex 5 of draw 1, by splat_ewa.vs"));
  EXPECT_NE(std::string::npos, text.find("end of the program"));
  EXPECT_NE(std::string::npos, text.find("oPos"));
  Trace later = trace;  // the same vertex, by the index that a script would give again
  std::get<Draw>(later.commands[2]).base_vertex = 3;
  const std::string moved = explain_vertex(later, {}, 1, 2);
  EXPECT_NE(std::string::npos, moved.find("vertex 2 of draw 1, by splat_ewa.vs"));
  EXPECT_EQ(moved.substr(moved.find('\n')), text.substr(text.find('\n')));
}

// A splat adds less than four decimals show.
TEST(Explain, WhatIsStoredIsToldInFull) {
  const Trace trace = small_trace("ewa-per-surfel");
  NumberFormats floats;
  floats.frame = FrameFormat::float32;
  const std::vector<PixelStep> steps = explain_pixel(trace, floats, 32, 24);
  const std::string text = describe(trace, floats, steps);
  const auto drawn = std::ranges::find_if(steps, [](const PixelStep& step) { return step.after[0] > 0; });
  ASSERT_NE(drawn, steps.end());
  EXPECT_NE(text.find(fmt::format("{:.9g} {:.9g} {:.9g}", drawn->after[0], drawn->after[1], drawn->after[2])),
            std::string::npos)
      << text;
}

// A machine whose RCP and RSQ have few bits is explained by these.
TEST(Explain, VertexProgramsRunInTheNumbersOfTheMachine) {
  const Trace trace = small_trace("ewa-per-surfel");
  NumberFormats few;
  few.reciprocal_bits = 8;
  EXPECT_NE(explain_vertex(trace, few, 1, 5), explain_vertex(trace, {}, 1, 5));
}

TEST(Explain, RefusesWhatIsNotThere) {
  const Trace trace = small_trace("ewa-per-surfel");
  EXPECT_THROW(explain_pixel(trace, {}, 64, 0), UserError);
  EXPECT_THROW(explain_pixel(trace, {}, 0, 48), UserError);
  EXPECT_THROW(explain_vertex(trace, {}, 2, 0), UserError);
  EXPECT_THROW(explain_vertex(trace, {}, 0, 4 * 24 * 20), UserError);
  EXPECT_NO_THROW(explain_vertex(trace, {}, 0, 4 * 24 * 20 - 1));
}

}  // namespace
}  // namespace splatscope::studies
