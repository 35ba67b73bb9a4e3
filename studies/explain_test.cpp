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
      EXPECT_EQ(rendered.frame.color(pixel), steps.back().color) << algorithm << " " << x << "," << y;
      EXPECT_EQ(rendered.frame.depth_value(pixel), steps.back().depth);
      for (const PixelStep& step : steps) triangles += step.kind == PixelStep::Kind::triangle;
    }
    EXPECT_GT(triangles, 20u);
  }
}

// Per surfel: out = source * source alpha + before.
TEST(Explain, EachStepAddsItsSource) {
  const Trace trace = small_trace("ewa-per-surfel");
  const std::vector<PixelStep> steps = explain_pixel(trace, {}, 32, 24);
  std::size_t added = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (!steps[i].passed || !steps[i].writes_color) continue;
    ++added;
    EXPECT_NEAR(steps[i].diffuse[3] * steps[i].texel[3], steps[i].source[3], 1.5 / 255) << "9-bit combiners";
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(steps[i - 1].exact[c] + steps[i].source[3] * steps[i].source[c], steps[i].exact[c], 1e-6);
      EXPECT_NEAR(std::min(steps[i].exact[c], 1.0f), steps[i].color[c], static_cast<double>(added) / 255);
    }
  }
  EXPECT_GT(added, 3u);
  EXPECT_NE(std::string::npos, describe(trace, steps).find("depth test passed"));
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
