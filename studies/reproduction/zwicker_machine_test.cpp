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
    EXPECT_GT(row.psnr_float, 50);
    ASSERT_EQ(row.frames.size(), 2u);
    for (const VolumeFrame& frame : row.frames) {
      EXPECT_GT(frame.psnr, 36) << frame.machine;  // 3 dB less than measured; the measure asks for 30
      EXPECT_GT(frame.seconds, 0);
    }
  }
}

TEST(ZwickerMachine, WiderFormatsAreNearerAndNoFaster) {
  const std::vector<FormatRow> rows = format_rows(volume_engine(96, 0.2), Fidelity::throughput);
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows.front().format, FrameFormat::unorm8);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    for (std::size_t m = 0; m < 2; ++m) {
      EXPECT_GT(rows[i].frames[m].psnr, rows[0].frames[m].psnr + 6) << i << ": two more bits";
      EXPECT_GE(rows[i].frames[m].seconds, 0.999 * rows[0].frames[m].seconds) << i << ": larger cache lines";
    }
  }
}

// The pixel unit's steps cost the most; the gains of the sheets bring it back.
TEST(ZwickerMachine, GainsBringBackWhatTheStepsOf8BitsCost) {
  const std::vector<StepRow> rows = step_rows(volume_foot(96, 0.2));
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_GT(rows[0].psnr_gains, rows[0].psnr_plain + 5);
  EXPECT_GT(rows[5].psnr_plain, 50) << "nothing is rounded but vertices and texels";
  EXPECT_NEAR(rows[5].psnr_gains, rows[5].psnr_plain, 3);
}

}  // namespace
}  // namespace splatscope::studies
