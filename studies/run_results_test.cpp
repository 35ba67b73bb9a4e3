#include "studies/run_results.h"

#include <gtest/gtest.h>

#include "studies/report/run_report.h"

namespace splatscope::studies {
namespace {

// Each figure is a number of its own, so that no two can change places.
Input numbered_input() {
  Input input;
  input.recorded = traces::RecordCounts{.scene_surfels = 1,
                                        .surfels = 2,
                                        .blocks = {.blocks = 3,
                                                   .surfels = 4,
                                                   .surfels_by_level = {5, 6},
                                                   .outside_frustum = 7,
                                                   .facing_away = 8},
                                        .weights_captured = 9,
                                        .weights_at_edges = 10,
                                        .weights_by_default = 11,
                                        .weights_outside_box = 12};
  input.skipped = {.not_finite = 13, .zero_radius = 14, .duplicate = 15, .zero_normal = 16};
  input.estimated = {.normals = 17, .radii = 18};
  input.mesh = {.triangles = 19,
                .triangles_not_finite = 20,
                .triangles_out_of_range = 21,
                .triangles_degenerate = 22,
                .normals_computed = 23,
                .textures_unreadable = 24,
                .materials_unreadable = 25};
  input.volume =
      traces::VolumeCounts{.splats = 26, .flat = 27, .left_out = 28, .sheets = 29, .vertex_bytes = 30};
  return input;
}

FrameRun numbered_run() {
  FrameRun run{.rendered = {Frame(1, 1, {}), {}, {}}, .timing = {}, .heat_maps = {}, .reference = {}};
  run.rendered.counters = {.vertices = 31,
                           .triangles = 32,
                           .triangles_without_coverage = 33,
                           .triangles_outside = 34,
                           .triangles_behind = 35,
                           .triangles_not_finite = 36,
                           .triangles_back_facing = 37,
                           .triangles_clipped = 38,
                           .quads = 39,
                           .fragments = 40,
                           .fragments_passed = 41};
  run.reference = AgainstReference{{},
                                   {.surface_pixels = 42,
                                    .psnr = 43,
                                    .worst = 44,
                                    .over_8 = 45,
                                    .pixels_off_edges = 46,
                                    .psnr_off_edges = 47,
                                    .inside_pixels = 48,
                                    .holes = 49,
                                    .rounded_to_black = 50}};
  run.host_seconds = 51;
  run.seed = 52;
  return run;
}

TEST(RunResults, EveryFigureStandsUnderItsName) {
  const nlohmann::json results = results_of(numbered_input(), {}, Fidelity::functional, numbered_run());
  EXPECT_EQ(results["surfels"], nlohmann::json::parse(R"({
    "total": 1, "drawn": 2, "normals_estimated": 17, "radii_estimated": 18,
    "blocks": {"drawn": 3, "surfels_by_level": [5, 6], "surfels_outside_frustum": 7, "surfels_facing_away": 8},
    "weights_captured": 9, "weights_at_edges": 10, "weights_by_default": 11, "weights_outside_box": 12,
    "skipped": {"not_finite": 13, "zero_radius": 14, "duplicate": 15, "zero_normal": 16}})"));
  EXPECT_EQ(results["mesh"], nlohmann::json::parse(R"({
    "triangles": 19, "triangles_not_finite": 20, "triangles_out_of_range": 21, "triangles_degenerate": 22,
    "normals_computed": 23, "textures_unreadable": 24, "materials_unreadable": 25})"));
  EXPECT_EQ(results["volume"], nlohmann::json::parse(R"({
    "splats": 26, "flat_splats": 27, "left_out": 28, "sheets": 29, "vertex_bytes": 30})"));
  EXPECT_EQ(results["counters"], nlohmann::json::parse(R"({
    "vertices": 31, "triangles": 32, "triangles_without_coverage": 33, "triangles_outside_frustum": 34,
    "triangles_behind_near": 35, "triangles_not_finite": 36, "triangles_back_facing": 37,
    "triangles_clipped": 38, "quads": 39, "fragments": 40, "fragments_passed": 41})"));
  EXPECT_EQ(results["reference"], nlohmann::json::parse(R"({
    "surface_pixels": 42, "psnr_decibels": 43.0, "worst": 44.0, "pixels_over_8": 45, "pixels_off_edges": 46,
    "psnr_off_edges_decibels": 47.0, "inside_pixels": 48, "holes": 49, "rounded_to_black": 50})"));
  EXPECT_EQ(results["host"]["seconds"], 51.0);
  EXPECT_EQ(results["seed"], 52);
}

// Two frames at 1 MHz.
sim::Result timed() {
  sim::Result timing;
  timing.cycles = 1'235'566;
  timing.seconds = 1.235566;
  timing.cycles_plus_minus = 60'000;
  timing.frame_cycles = {1'234'567, 999};
  timing.frame_plus_minus = {54'321, 0};
  timing.units.push_back({.name = "raster", .busy = 1'235'566, .blocked_by = {}});
  return timing;
}

TEST(RunResults, AFrameHasItsOwnTime) {
  const nlohmann::json frames = timing_json(timed())["frames"];
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0]["cycles"], 1'234'567);
  EXPECT_NEAR(frames[0]["milliseconds"].get<double>(), 1234.567, 1e-9);
  EXPECT_NEAR(frames[0]["frames_per_second"].get<double>(), 1 / 1.234567, 1e-9);
  EXPECT_EQ(frames[0]["cycles_plus_minus"], 54'321);
  EXPECT_EQ(frames[1]["cycles_plus_minus"], 0);
}

TEST(RunResults, ThePageHasItsTimesAndCounts) {
  FrameRun run = numbered_run();
  run.timing = timed();
  run.reference = {};
  run.rendered.counters.fragments = 40'000;
  const Machine machine = machine::load(machine::kGeForce4);
  const auto results = results_of(numbered_input(), machine, Fidelity::sampled, run);
  EXPECT_EQ(
      nlohmann::json(results["totals"][0]),
      nlohmann::json::parse(R"({"name": "vertices", "value": 31, "unit": "vertices", "what": "shaded"})"));
  const std::string page = run_report(numbered_input(), machine, run, results).html();
  for (const char* cell : {">1 234 567 ± 54 321<", ">1234.567<", ">0.81<", ">999<", ">0.999<", ">40 000<"})
    EXPECT_NE(page.find(cell), std::string::npos) << cell;
}

}  // namespace
}  // namespace splatscope::studies
