#include <gtest/gtest.h>

#include <memory>

#include "kernels/object_space_ewa/programs.h"
#include "model/isa/program.h"
#include "model/pixel/pixel_program.h"

namespace splatscope::kernels {
namespace {

// r0 for diffuse (0.5, 0.25, 1, 0.5) and a texel whose colour must not matter.
Vec4 run(std::string_view name) {
  const pixel::PixelProgram program(load_program(name));
  EXPECT_EQ(program.texture_stages(), 1u);
  const auto batch = std::make_unique<pixel::FragmentBatch>();
  const Vec4 diffuse{0.5f, 0.25f, 1.0f, 0.5f};
  const Vec4 texel{0.125f, 0.875f, 0.0f, 0.75f};
  for (std::size_t i = 0; i < 4; ++i) {
    batch->v0[i][0] = diffuse[i];
    batch->t[0][i][0] = texel[i];
  }
  program.run({}, *batch, 1);
  return {batch->r0[0][0], batch->r0[1][0], batch->r0[2][0], batch->r0[3][0]};
}

TEST(PixelPrograms, ColourAndWeightApart) {
  EXPECT_EQ(run(kSplatPixelProgram), (Vec4{0.5f, 0.25f, 1.0f, 0.375f}));
  EXPECT_EQ(isa::slot_count(load_program(kSplatPixelProgram)), 2);
}

TEST(PixelPrograms, ColourTimesWeight) {
  EXPECT_EQ(run(kWeightedSplatPixelProgram), (Vec4{0.1875f, 0.09375f, 0.375f, 0.375f}));
  EXPECT_EQ(isa::slot_count(load_program(kWeightedSplatPixelProgram)), 3);
}

}  // namespace
}  // namespace splatscope::kernels
