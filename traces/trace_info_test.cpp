#include "traces/trace_info.h"

#include <gtest/gtest.h>

namespace splatscope::traces {
namespace {

// A draw of depth alone, one into a surface and one from it.
TEST(TraceInfo, HasALineForEachPart) {
  Trace trace;
  trace.width = 4;
  trace.height = 2;
  trace.surfaces = 1;
  trace.buffers = {{MemoryPlace::video, std::vector<std::byte>(12)},
                   {MemoryPlace::agp, std::vector<std::byte>(6)}};
  trace.textures.push_back({.width = 8, .height = 4, .texels = {}});
  trace.programs = {{"a.vs", "vs"}, {"b.ps", "ps_"}};
  Draw depth;
  depth.vertex_stride = 16;
  depth.index_count = 9;
  depth.state.color_write = false;
  depth.state.cull = CullMode::counter_clockwise;
  Draw into;
  into.pixel_program = 1;
  into.texture = 0;
  into.target = 1;
  into.vertex_buffer = 1;
  into.vertex_stride = 20;
  into.index_count = 6;
  into.state.depth_test = into.state.depth_write = false;
  into.state.blend = true;
  Draw from = into;
  from.texture = {};
  from.target = 0;
  from.source = 1;
  from.state.blend = false;
  from.state.cull = CullMode::clockwise;
  trace.commands = {Clear{{0.5f, 0, 1, 0}, 1}, depth, Present{}, into, from, NormalizeOnHost{}, Present{}};
  EXPECT_EQ(
      describe(trace),
      "frame      4 x 2\n"
      "frames     2\n"
      "surfaces   1 off-screen\n"
      "buffer     0: 12 bytes in video memory\n"
      "buffer     1: 6 bytes in AGP memory\n"
      "texture    0: 8 x 4, 8-bit alpha\n"
      "program    0: a.vs, 2 bytes\n"
      "program    1: b.ps, 3 bytes\n"
      "command    0: clear to r 0.5 g 0 b 1 a 0, depth 1\n"
      "command    1: draw 3 triangles, a.vs, 16 bytes a vertex from video memory, depth test, depth write, "
      "counter-clockwise culled\n"
      "command    2: present\n"
      "command    3: draw 2 triangles, a.vs, b.ps, 20 bytes a vertex from AGP memory, texture 0, into "
      "surface 1, blended\n"
      "command    4: draw 2 triangles, a.vs, b.ps, 20 bytes a vertex from AGP memory, from surface 1, "
      "colour write, clockwise culled\n"
      "command    5: normalize on the host\n"
      "command    6: present\n");
}

}  // namespace
}  // namespace splatscope::traces
