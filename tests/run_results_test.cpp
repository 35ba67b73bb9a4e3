#include <cctype>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <span>

#include "command_line.h"
#include "model/testing/draws.h"
#include "traces/trace_file.h"

// That results.json counts what was drawn, by a trace of which every count can be found by hand, and that
// `run` prints the same.
namespace splatscope::tests {
namespace {

using Json = nlohmann::json;
using splatscope::testing::buffer_of;

struct Corner {
  float x, y, z, w;  // clip space
};

// Of a frame of 16 x 16: at a place in pixels, whose centres have whole numbers (as in Direct3D 8), at a
// depth.
constexpr Corner at(float x, float y, float z) {
  return {x / 8 - 1, 1 - y / 8, z, 1};
}

// The first has its right angle in the centre of the frame's first pixel and legs of 7.5 pixels, so that it
// covers the centres of columns and rows i + j <= 7: 36 fragments in 10 quads of one tile. The second lies
// behind it.
constexpr Corner kDrawn[] = {at(0, 0, 0.25f), at(7.5f, 0, 0.25f), at(0, 7.5f, 0.25f),
                             at(0, 0, 0.5f),  at(7.5f, 0, 0.5f),  at(0, 7.5f, 0.5f)};
// The near plane leaves legs of 3.5: i + j <= 3, 10 fragments in 3 quads of one tile.
constexpr Corner kCutToOne[] = {at(8, 0, 0.5f), at(15, 0, -0.5f), at(8, 7, -0.5f)};
// The near plane leaves a quadrilateral, two triangles, in a place without a pixel's centre.
constexpr Corner kCutToTwo[] = {at(12.6f, 12.6f, 0.5f), at(12.9f, 12.6f, -0.5f), at(12.6f, 12.9f, 0.5f)};
constexpr Corner kBetweenCentres[] = {at(2.6f, 12.6f, 0.5f), at(2.9f, 12.6f, 0.5f), at(2.6f, 12.9f, 0.5f)};
constexpr Corner kOutside[] = {at(17, 0, 0.5f), at(20, 0, 0.5f), at(17, 8, 0.5f)};
constexpr Corner kBehind[] = {at(0, 0, -0.5f), at(8, 0, -0.5f), at(0, 8, -0.5f)};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const Corner kNotFinite[] = {at(0, 0, 0.5f), at(8, kNan, 0.5f), at(0, 8, 0.5f)};
constexpr Corner kTurned[] = {at(0, 0, 0.1f), at(0, 8, 0.1f), at(8, 0, 0.1f)};
constexpr std::uint32_t kTriangles = 9;

Trace countable_trace() {
  std::vector<Corner> corners;
  for (const std::span<const Corner> triangles : std::initializer_list<std::span<const Corner>>{
           kDrawn, kCutToOne, kCutToTwo, kBetweenCentres, kOutside, kBehind, kNotFinite, kTurned})
    corners.insert(corners.end(), triangles.begin(), triangles.end());
  std::vector<std::uint16_t> indices(corners.size());
  std::iota(indices.begin(), indices.end(), std::uint16_t{0});
  Trace trace;
  trace.width = trace.height = 16;
  trace.buffers = {buffer_of(corners), buffer_of(indices)};
  trace.programs = {{"two.vs", "vs_1_1\nmov oPos, v0\nmov oD0, c0\n"}, {"one.ps", "ps_1_1\nmov r0, v0\n"}};
  Draw draw;
  draw.pixel_program = 1;
  draw.vertex_stride = sizeof(Corner);
  draw.attributes = {{0, VertexFormat::float4, 0}};
  draw.index_buffer = 1;
  draw.index_count = 3 * kTriangles;
  draw.constants = {{1, 1, 1, 1}};
  draw.state.depth_test = draw.state.depth_write = true;
  draw.state.cull = CullMode::counter_clockwise;
  trace.commands = {Clear{{0, 0, 0, 0}, 1}, draw, NormalizeOnHost{}};
  return trace;
}

// The sums over units of one kind: "memory.reads" over all channels.
std::map<std::string, std::uint64_t> statistics_of(const Json& results) {
  std::map<std::string, std::uint64_t> sums;
  for (const Json& statistic : results["statistics"]) {
    std::string unit = statistic["of"];
    while (!unit.empty() && std::isdigit(static_cast<unsigned char>(unit.back()))) unit.pop_back();
    sums[unit + "." + statistic["name"].get<std::string>()] += statistic["value"].get<std::uint64_t>();
  }
  return sums;
}

TEST(RunResults, CountWhatCanBeCountedByHand) {
  const ScratchFolder folder;
  traces::write_trace(countable_trace(), folder.path() / "t.trace");
  const Outcome run = run_program({"run", "t.trace", "--out", "out"}, folder.path());
  ASSERT_EQ(run.status, 0) << run.error;
  const Json results = results_in(folder.path() / "out");
  EXPECT_EQ(results["counters"], Json::parse(R"({"vertices": 27, "triangles": 9,
      "triangles_without_coverage": 2, "triangles_outside_frustum": 1, "triangles_behind_near": 1,
      "triangles_not_finite": 1, "triangles_back_facing": 1, "triangles_clipped": 1,
      "quads": 23, "fragments": 82, "fragments_passed": 46})"));
  for (const Json& total : results["totals"])
    EXPECT_EQ(total["value"], results["counters"].at(total["name"].get<std::string>())) << total;
  EXPECT_EQ(results["programs"],
            Json::parse(R"([{"name": "two.vs", "slots": 2}, {"name": "one.ps", "slots": 1}])"));
  auto statistics = statistics_of(results);
  const auto expect = [&](const std::string& name, std::uint64_t value) {
    ASSERT_TRUE(statistics.contains(name)) << name;
    EXPECT_EQ(statistics[name], value) << name;
  };
  expect("command.bytes_filled", 16 * 16 * 4);  // the colour: depth is marked as cleared
  expect("vertex_fetch.indices", 27);
  expect("vertex_fetch.vertices", 27);
  expect("vertex_fetch.line_touches", 27);  // of 64 bytes, four vertices
  expect("vertex_fetch.line_misses", 7);
  expect("vertex.vertices", 27);
  expect("vertex.issue_slots", 27 * 2);
  expect("primitive.assembled", 5);
  expect("primitive.rejected", 4);
  expect("primitive.clipped", 1);
  expect("setup.triangles", 6);
  expect("raster.quads", 23);
  expect("raster.tiles", 3);
  expect("raster.empty_triangles", 2);
  expect("depth.tested", 23);
  expect("depth.passed", 13);
  expect("depth.misses", 4);  // lines of 4 x 4 pixels, of which the first triangle has three
  expect("depth.write_backs", 4);
  expect("pixel.quads", 13);
  expect("blend.quads", 13);
  expect("blend.misses", 4);
  expect("blend.write_backs", 4);
  expect("memory.reads", 1 + 7);  // of indices and vertices: no line of the frame is read
  expect("memory.writes", 1024 / 64 + 4 + 4);
  expect("host.commands", 3);
  expect("host.pixels_normalized", 16 * 16);
}

// Of a sphere that reaches before the near plane and out of the frame, with weights from one side and in a
// part of it: no two of these numbers are the same.
TEST(RunResults, ArePrinted) {
  const ScratchFolder folder;
  folder.file("near.toml",
              "surfels = { generator = \"sphere\", count = 1500 }\nframe = { width = 96, height = 96 }\n"
              "camera = { eye = [0, 0, 2], target = [0.4, 0, 0], near = 1.2, fov_y_degrees = 40 }\n"
              "hierarchy.culling = \"none\"\n"
              "capture = { views = 1, frame_size = 64, box_min = [-0.5, -9, -9] }\n");
  const Outcome outcome = run_program({"run", "near.toml", "--out", "o", "--reference"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto results = results_in(folder.path() / "o");
  const auto &surfels = results["surfels"], &counters = results["counters"],
             &reference = results["reference"];
  const auto count = [](const nlohmann::json& of, const char* name) { return of[name].get<std::size_t>(); };
  for (const std::string& line :
       {fmt::format(
            "weights: {} captured, {} of them a vertex; {} seen from no view, {} outside of the box\n",
            count(surfels, "weights_captured"), count(surfels, "weights_at_edges"),
            count(surfels, "weights_by_default"), count(surfels, "weights_outside_box")),
        fmt::format(
            "dropped: {} outside the frustum, {} before the near plane, {} back-facing, 0 not finite\n",
            count(counters, "triangles_outside_frustum"), count(counters, "triangles_behind_near"),
            count(counters, "triangles_back_facing")),
        fmt::format(" cycles, {:.2f} ms, ", results["frames"][0]["milliseconds"].get<double>()),
        fmt::format(", {:.1f} dB over the {} of them off edges",
                    reference["psnr_off_edges_decibels"].get<double>(),
                    count(reference, "pixels_off_edges"))})
    EXPECT_NE(outcome.out.find(line), std::string::npos) << line << outcome.out;
  const std::set<std::size_t> distinct{
      count(surfels, "weights_captured"),           count(surfels, "weights_by_default"),
      count(surfels, "weights_outside_box"),        count(reference, "pixels_off_edges"),
      count(counters, "triangles_outside_frustum"), count(counters, "triangles_behind_near"),
      count(counters, "triangles_back_facing"),     0};
  EXPECT_EQ(distinct.size(), 8u) << outcome.out;
}

}  // namespace
}  // namespace splatscope::tests
