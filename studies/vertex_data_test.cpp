#include "studies/vertex_data.h"

#include <gtest/gtest.h>

#include <cmath>

namespace splatscope::studies {
namespace {

// A small plane: the vertices' work and bytes decide, as on the large ones.
TEST(VertexData, ProgramsTradeInstructionsForBytes) {
  const traces::Scene scene = traces::parse_scene(
      "[surfels]\ngenerator = \"plane\"\ncolumns = 48\nrows = 48\n[frame]\nwidth = 96\nheight = 96\n"
      "[splatting]\nalgorithm = \"ewa-per-surfel\"\n[capture]\nviews = 2\nframe_size = 96\n"
      "corner_weights = false\n",
      "plane");
  const std::vector<VertexDataRow> rows = vertex_data_rows(scene);
  ASSERT_EQ(12u, rows.size());
  const std::size_t pairs = rows.size() / 2;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const VertexDataRow& row = rows[i];
    const VertexDataRow& paper = rows[i < pairs ? 0 : pairs];
    SCOPED_TRACE(std::string(row.programs.visibility) + ", " + std::string(row.programs.ewa) + " on " +
                 row.machine);
    EXPECT_EQ(row.machine, paper.machine);
    // What video memory gains by not being asked for vertices is little.
    EXPECT_LE(row.agp.fps, 1.01 * row.video.fps);
    const Machine machine = machine::load(row.machine);
    EXPECT_LT(row.agp.fps * row.surfel_bytes() * 48 * 48,
              1e6 * machine.clock.bus_megahertz * machine.agp.bytes_per_clock)
        << "more than AGP carries";
    if (&row == &paper) {
      EXPECT_EQ(13 + 78, row.slots());
      EXPECT_EQ(4u * (56 + 56), row.surfel_bytes());
      EXPECT_TRUE(std::isinf(row.psnr));
      continue;
    }
    EXPECT_LT(row.slots(), paper.slots());
    EXPECT_GT(row.video.fps, paper.video.fps);
    EXPECT_GT(row.psnr, 45) << "the same Gaussians, rounded otherwise";
  }
}

// Each figure is a number of its own, so that no two can change places.
TEST(VertexData, EveryFigureStandsUnderItsName) {
  const VertexDataRow row{.programs = {"a", "b"},
                          .machine = "c",
                          .visibility_slots = 1,
                          .ewa_slots = 2,
                          .visibility_bytes = 3,
                          .ewa_bytes = 4,
                          .video = {5, "d", 0.5},
                          .agp = {6, "e", 0.5},
                          .psnr = 7};
  EXPECT_EQ(nlohmann::json(json_of({row})), nlohmann::json::parse(R"([{
    "visibility_program": "a", "ewa_program": "b", "machine": "c", "vs1": 1, "vs2": 2, "vertex_bytes_1": 3,
    "vertex_bytes_2": 4, "surfel_bytes": 28, "video": {"frames_per_second": 5.0, "bottleneck": "d"},
    "agp": {"frames_per_second": 6.0, "bottleneck": "e"}, "psnr_decibels": 7.0}])"));
}

}  // namespace
}  // namespace splatscope::studies
