#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "model/render.h"
#include "traces/splat_trace.h"

// Whatever a finite surfel holds: where its centre survives clipping, no vertex of the default programs is
// NaN or INF.
namespace splatscope::traces {
namespace {

// Any bits of a finite float.
rc::Gen<float> finite() {
  return rc::gen::map(
      rc::gen::suchThat(rc::gen::arbitrary<std::uint32_t>(),
                        [](std::uint32_t bits) { return (bits & 0x7f800000u) != 0x7f800000u; }),
      [](std::uint32_t bits) { return std::bit_cast<float>(bits); });
}

// From -1 to 1, as small as a float can be.
rc::Gen<float> fraction() {
  return rc::gen::map(finite(), [](float x) { return std::abs(x) > 1 ? 1 / x : x; });
}

float magnitude(float x) {
  return std::max(std::abs(x), std::numeric_limits<float>::denorm_min());
}

glm::vec3 unit(float x, float y, float z) {
  const glm::dvec3 v{x, y, z};
  return v == glm::dvec3(0) ? glm::vec3(0, 0, 1) : glm::vec3(glm::normalize(v));
}

RC_GTEST_PROP(ExtremeSurfels, StayFiniteWhereTheySurviveClipping, ()) {
  Scene scene =
      parse_scene("[frame]\nwidth = 32\nheight = 32\n[surfels]\ncolumns = 1\nrows = 1\n", "extreme");
  const kernels::View view = view_of(scene.camera, scene.frame);
  // In the frustum: camera z from near to far by its logarithm, x and y as fractions of the frame.
  const double depth = scene.camera.near * std::pow(scene.camera.far / scene.camera.near,
                                                    0.5 * (1 + static_cast<double>(*fraction())));
  const glm::dvec3 inside{depth * *fraction() * 0.5 * view.width / view.eta,
                          depth * *fraction() * 0.5 * view.height / view.eta, depth};
  Surfel surfel;
  surfel.position = glm::vec3(glm::inverse(view.object_to_camera) * glm::dvec4(inside, 1));
  surfel.normal = unit(*finite(), *finite(), *finite());
  surfel.radius = magnitude(*finite());
  surfel.color = {1, 1, 1};
  const VertexWeights weights = equal_weights(0.73);
  const Trace trace = splat_trace({{&surfel, 1}, {&weights, 1}}, view, scene.splatting, {});
  for (const Arithmetic arithmetic : {Arithmetic::ieee, Arithmetic::nv20}) {
    RenderOptions options;
    options.formats.vertex_arithmetic = arithmetic;
    options.formats.color = ColorFormat::float32;
    options.formats.frame = FrameFormat::float32;
    const Rendered rendered = render(trace, options);
    RC_ASSERT(rendered.counters.triangles_not_finite == 0u);
    for (const Vec4& color : rendered.frame.colors32) {
      for (const float channel : color) RC_ASSERT(std::isfinite(channel));
    }
  }
}

}  // namespace
}  // namespace splatscope::traces
