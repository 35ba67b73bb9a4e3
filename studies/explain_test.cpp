#include "studies/explain.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/error.h"
#include "model/render.h"
#include "traces/recorder.h"

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

TEST(Explain, VertexProgramsAreTold) {
  const Trace trace = small_trace("ewa-per-surfel");
  const std::string text = explain_vertex(trace, {}, 1, 5);
  EXPECT_NE(std::string::npos, text.find("vertex 5 of draw 1, by splat_ewa.vs"));
  EXPECT_NE(std::string::npos, text.find("end of the program"));
  EXPECT_NE(std::string::npos, text.find("oPos"));
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
