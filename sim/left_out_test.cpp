#include "sim/left_out.h"

#include <gtest/gtest.h>

#include <ostream>

namespace splatscope::sim {

void PrintTo(const UnitLeftOut& entry, std::ostream* out) {
  *out << entry.name << ": " << entry.why;
}

namespace {

using List = std::vector<UnitLeftOut>;

// Draws of ten triangles each, with all that a draw can use.
struct Draws {
  explicit Draws(std::size_t count) : draws(count) {
    trace.buffers = {{MemoryPlace::agp, {}}, {MemoryPlace::video, {}}};
    for (Draw& draw : draws) {
      draw.index_count = 30;
      draw.texture = 0;
      draw.state = {true, true, true, true, BlendFactor::one, BlendFactor::one};
    }
  }

  List left_out() const {
    Trace whole = trace;
    whole.commands.assign(draws.begin(), draws.end());
    std::vector<DrawJob> jobs(draws.size());
    for (std::size_t i = 0; i < draws.size(); ++i) {
      jobs[i].draw = &draws[i];
      jobs[i].textured = binds_texture(draws[i]);
      jobs[i].triangles_clipped = clipped;
    }
    return sim::left_out(whole, needs_of(whole, jobs), jobs);
  }

  std::vector<Draw> draws;
  Trace trace;
  std::uint64_t clipped = 10;  // of each draw
};

TEST(LeftOut, NothingWhereEveryDrawUsesEverything) {
  EXPECT_EQ(Draws(3).left_out(), List{});
}

TEST(LeftOut, UnitsAndWork) {
  Draws made(2);
  made.trace.buffers[0].place = MemoryPlace::video;
  for (Draw& draw : made.draws) {
    draw.state.blend = draw.state.depth_test = draw.state.depth_write = false;
    draw.texture.reset();
  }
  made.clipped = 0;
  EXPECT_EQ(made.left_out(),
            (List{{"agp", "every buffer is in video memory"},
                  {"depth", "no draw tests or writes depth"},
                  {"texture", "no draw that writes colour samples a texture"},
                  {"destination read", "no draw blends"},
                  {"clipping of 20 of 20 triangles", "each stays one piece or is rejected"}}));
  for (Draw& draw : made.draws) draw.state.color_write = false;
  const List dark = made.left_out();
  ASSERT_EQ(dark.size(), 6u);
  EXPECT_EQ(dark[2], (UnitLeftOut{"texture", "no draw writes colour"}));
  EXPECT_EQ(dark[4], (UnitLeftOut{"blend", "no draw writes colour"}));
}

// The first pass of EWA splatting writes no colour; whatever follows it uses less of the machine.
TEST(LeftOut, WhatSomeDrawsGoPast) {
  Draws made(5);
  made.draws[0].state.color_write = false;
  made.draws[1].state.color_write = false;
  made.draws[2].texture.reset();
  made.draws[3].state.blend = false;
  made.draws[3].state.depth_test = made.draws[3].state.depth_write = false;
  made.draws[4].vertex_buffer = 1;
  made.draws[4].index_buffer = 1;
  made.clipped = 3;
  EXPECT_EQ(made.left_out(),
            (List{{"agp in 1 of 5 draws", "their buffers are in video memory"},
                  {"depth in 1 of 5 draws", "they neither test nor write depth"},
                  {"texture, pixel and blend in 2 of 5 draws", "they write no colour"},
                  {"texture in 1 of 5 draws", "they write colour and sample no texture"},
                  {"destination read in 1 of 5 draws", "they write colour without blending"},
                  {"clipping of 35 of 50 triangles", "each stays one piece or is rejected"}}));
}

}  // namespace
}  // namespace splatscope::sim
