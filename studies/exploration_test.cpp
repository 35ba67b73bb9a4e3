#include "studies/exploration.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/testing/scratch_folder.h"
#include "studies/wished_hardware.h"

namespace splatscope::studies {
namespace {

traces::Scene small_scene() {
  return traces::parse_scene(
      "[surfels]\ngenerator = \"plane\"\ncolumns = 48\nrows = 48\n[frame]\nwidth = 96\nheight = 96\n"
      "[splatting]\nalgorithm = \"ewa-per-surfel\"\n[capture]\nviews = 2\nframe_size = 96\n",
      "plane");
}

const ProgramRow& row_of(const std::vector<ProgramRow>& rows, std::string_view name) {
  return *std::ranges::find(rows, name, &ProgramRow::name);
}

const Hardware& hardware(std::string_view name) {
  return *std::ranges::find(wished_hardware(), name, &Hardware::name);
}

// On the plane of Table 1, simulated cycle by cycle.
TEST(Exploration, AProgramOf30SlotsNearlyDoublesTheFrameRate) {
  constexpr std::string_view kNames[] = {"paper", "facing"};
  const auto rows =
      program_rows(traces::load_scene("checkerboard-ewa-per-surfel"), kNames, Fidelity::cycle, 2000);
  const ProgramRow& paper = row_of(rows, "paper");
  const ProgramRow& facing = row_of(rows, "facing");
  EXPECT_EQ(paper.slots, 78);
  EXPECT_LE(facing.slots, 30);
  EXPECT_TRUE(facing.live);
  EXPECT_GE(facing.rates[0].fps, 1.9 * paper.rates[0].fps);
  EXPECT_GE(facing.psnr_paper, 45);
  EXPECT_GE(facing.psnr_paper_one_weight, 45);
  EXPECT_GE(facing.psnr_reference, paper.psnr_reference - 1);
  for (const ProgramRow& row : rows) {
    SCOPED_TRACE(row.name);
    EXPECT_TRUE(row.live);
    for (const kernels::SplatErrors& errors : {row.ieee, row.nv20}) {
      EXPECT_LT(errors.deviation, 0.005);
      EXPECT_LT(errors.weight, 0.005);
    }
  }
}

// What each wish is for, on a small plane.
TEST(Exploration, WishesDoWhatTheyAreFor) {
  const std::vector<Hardware> wishes{hardware("as it was"),          hardware("4 vertex units"),
                                     hardware("half frame"),         hardware("divider"),
                                     hardware("4 corners a vertex"), hardware("point sprites"),
                                     hardware("short programs")};
  const auto rows = hardware_rows(small_scene(), kBothMachines[0], wishes);
  constexpr std::size_t kPixel = 1, kSurfel = 2;
  const auto& base = rows[0].cells;
  const auto fps = [&](std::size_t row, std::size_t cell) { return rows[row].cells[cell].rate.fps; };
  EXPECT_EQ(base[kPixel].rate.bottleneck, "host");
  EXPECT_GT(fps(1, kSurfel), 1.5 * base[kSurfel].rate.fps) << "4 vertex units";
  EXPECT_GT(rows[2].cells[kSurfel].megabytes, base[kSurfel].megabytes) << "half frame";
  EXPECT_GT(rows[2].cells[kPixel].psnr, base[kPixel].psnr + 2) << "half frame";
  EXPECT_GT(fps(3, kPixel), 0.9 * fps(3, kSurfel)) << "divider";
  EXPECT_EQ(rows[3].cells[kPixel].psnr, base[kPixel].psnr) << "divider";
  EXPECT_GT(fps(4, kSurfel), 1.5 * base[kSurfel].rate.fps) << "4 corners";
  EXPECT_LT(rows[4].cells[kSurfel].megabytes, base[kSurfel].megabytes) << "4 corners";
  EXPECT_GT(fps(5, kSurfel), fps(4, kSurfel)) << "point sprites";
  EXPECT_LT(rows[5].cells[kPixel].psnr, base[kPixel].psnr - 5) << "point sprites are no ellipses";
  EXPECT_EQ(
      rows[5].cells[kSurfel].psnr,
      hardware_picture(small_scene(), kBothMachines[0], wishes[5], traces::Algorithm::ewa_per_surfel).psnr)
      << "sprites have weights of their own";
  EXPECT_GT(fps(6, kSurfel), 1.5 * base[kSurfel].rate.fps) << "short programs";
}

// Lines of docs/exploration.md, made again.
TEST(Exploration, TheDocumentationHolds) {
  const std::string page = text_of(SPLATSCOPE_SOURCE "/docs/exploration.md");
  const std::vector<Hardware> wishes{hardware("as it was"), hardware("8 vertex units"), hardware("divider")};
  for (const HardwareRow& row :
       hardware_rows(traces::load_scene("checkerboard-ewa-per-surfel"), kBothMachines[1], wishes)) {
    EXPECT_NE(page.find(line_of(row)), std::string::npos) << line_of(row);
  }
}

}  // namespace
}  // namespace splatscope::studies
