#include "sim/draw_jobs.h"

#include <gtest/gtest.h>

#include "sim/testing/random_trace.h"

namespace splatscope::sim {
namespace {

TEST(DrawJobs, ADrawKnowsWhereItsIndicesAndTexelsLie) {
  testing::RandomTrace made = testing::simple_trace(2);
  made.trace.surfaces = 2;
  Draw& draw = std::get<Draw>(made.trace.commands[1]);
  draw.first_index = 30;
  const Machine machine = machine::load(machine::kGeForce4);
  const MemoryLayout layout = lay_out(made.trace, machine);
  const auto job = [&] { return prepare_draws(made.trace, machine, layout).jobs[0]; };
  EXPECT_EQ(job().vertex_address, layout.buffers[0]);
  EXPECT_EQ(job().index_address, layout.buffers[1] + 60);
  EXPECT_EQ(job().texture_address, layout.textures[0]);
  draw.source = 2;
  EXPECT_EQ(job().texture_address, layout.color_address + 2 * layout.color.bytes());
}

}  // namespace
}  // namespace splatscope::sim
