#include "model/render.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <string>

namespace splatscope {
namespace {

template <typename Value, std::size_t kCount>
Buffer buffer_of(const std::array<Value, kCount>& values) {
  Buffer buffer;
  buffer.bytes.resize(sizeof(values));
  std::memcpy(buffer.bytes.data(), values.data(), sizeof(values));
  return buffer;
}

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

}  // namespace
}  // namespace splatscope
