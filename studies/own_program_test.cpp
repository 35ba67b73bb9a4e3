#include "studies/own_program.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "model/error.h"
#include "model/render.h"
#include "traces/recorder.h"

namespace splatscope::studies {
namespace {

std::string written(const char* name, const std::string& text) {
  const std::string path = (std::filesystem::path(::testing::TempDir()) / name).string();
  std::ofstream(path) << text;
  return path;
}

TEST(OwnProgram, TakesThePlaceOfTheRecordedOne) {
  const traces::Scene scene = traces::parse_scene(
      "surfels = { columns = 8, rows = 8 }\nframe = { width = 16, height = 16 }\ncapture.views = 1\n"
      "camera = { eye = [0, 5, 5], target = [0, 0, 0] }\n",
      "s.toml");
  Trace trace = traces::record(scene, NumberFormats{}).trace;
  const Frame before = render(trace, {}).frame;
  // Draws nothing: every vertex in one place.
  const std::string file = written("own.vs", "vs_1_1\nmov oPos, c0\nmov oD0, v0\nmov oT0, v0\n");
  replace_program(trace, "splat_ewa.vs=" + file);
  EXPECT_EQ(file, trace.programs.back().name == file ? file : trace.programs[1].name);
  EXPECT_NE(before, render(trace, {}).frame);
}

TEST(OwnProgram, IsRefusedWhereItIsWrong) {
  const traces::Scene scene = traces::parse_scene(
      "surfels = { columns = 8, rows = 8 }\nframe = { width = 16, height = 16 }\ncapture.views = 1\n",
      "s.toml");
  const Trace trace = traces::record(scene, NumberFormats{}).trace;
  const auto refused = [&](const std::string& assignment) {
    Trace changed = trace;
    EXPECT_THROW(replace_program(changed, assignment), UserError) << assignment;
  };
  refused("splat_ewa.vs");
  refused("none.vs=" + written("fine.vs", "vs_1_1\nmov oPos, v0\n"));
  refused("splat_ewa.vs=/no/such/file.vs");
  refused("splat_ewa.vs=" + written("wrong.vs", "vs_1_1\nmov oPos, v99\n"));
  refused("splat_ewa.vs=" + written("pixel.ps", "ps_1_1\nmov r0, v0\n"));
}

}  // namespace
}  // namespace splatscope::studies
