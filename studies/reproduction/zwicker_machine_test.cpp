#include "studies/reproduction/zwicker_machine.h"

#include <gtest/gtest.h>

namespace splatscope::studies {
namespace {

// The three volumes with a fifth of the voxels along each axis, by throughput fidelity.
TEST(ZwickerMachine, MachinesDrawWhatTheSoftwareDoesWithTheSameSheets) {
  for (const auto make : {volume_head, volume_engine, volume_foot}) {
    const VolumeModel model = make(96, 0.2);
    const VolumeRow row = volume_row(model, Fidelity::throughput);
    SCOPED_TRACE(row.name);
    EXPECT_GT(row.splats, 1000u);
    EXPECT_GT(row.flat, 0u);
    EXPECT_LT(row.flat, row.splats);
    EXPECT_GT(row.psnr_8_bits, 30);
    EXPECT_GT(row.psnr_float, 50);
    ASSERT_EQ(row.frames.size(), 2u);
    for (const VolumeFrame& frame : row.frames) EXPECT_GT(frame.seconds, 0);
  }
}

TEST(ZwickerMachine, WiderFormatsAreNearerAndNoFaster) {
  const std::vector<FormatRow> rows = format_rows(volume_engine(96, 0.2), Fidelity::throughput);
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows.front().format, FrameFormat::unorm8);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_GT(rows[i].psnr, rows[0].psnr + 6) << i << ": two more bits";
    for (std::size_t m = 0; m < 2; ++m)
      EXPECT_GE(rows[i].frames[m].seconds, 0.999 * rows[0].frames[m].seconds) << i << ": larger cache lines";
  }
}

}  // namespace
}  // namespace splatscope::studies
