#include "studies/own_program.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/command/load_program.h"
#include "model/isa/tokens.h"
#include "model/render.h"
#include "model/testing/scratch_folder.h"
#include "traces/recorder.h"

namespace splatscope::studies {
namespace {

std::string written(const char* name, const std::string& text) {
  static const ScratchFolder folder;
  return folder.file(name, text).string();
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
  EXPECT_EQ(std::vector<std::string>{"program splat_ewa.vs replaced by " + file + " (3 slots, was 78)"},
            replace_programs(trace, {"splat_ewa.vs=" + file}));
  EXPECT_EQ(file, trace.programs.back().name == file ? file : trace.programs[1].name);
  EXPECT_NE(before, render(trace, {}).frame);
}

void expect_start(const std::string& text, const std::string& start) {
  EXPECT_EQ(text.substr(0, start.size()), start) << text;
}

Trace small_trace() {
  const traces::Scene scene = traces::parse_scene(
      "surfels = { columns = 8, rows = 8 }\nframe = { width = 16, height = 16 }\ncapture.views = 1\n",
      "s.toml");
  return traces::record(scene, NumberFormats{}).trace;
}

TEST(OwnProgram, MayBeTokens) {
  Trace text = small_trace(), tokens = text;
  const ShaderText& recorded = *std::ranges::find(text.programs, "splat_ewa.vs", &ShaderText::name);
  const auto bytes = isa::bytes_of_tokens(isa::write_tokens(load_program(recorded)));
  const std::string file = written("own.vso", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  replace_programs(tokens, {"splat_ewa.vs=" + file});
  EXPECT_EQ(render(text, {}).frame, render(tokens, {}).frame);
  EXPECT_TRUE(std::ranges::any_of(tokens.programs, [&](const ShaderText& program) {
    return program.name == file && program.text.starts_with("vs_1_1\n");
  }));
}

TEST(OwnProgram, IsRefusedWhereItIsWrong) {
  const Trace trace = small_trace();
  const auto error_of = [&](const std::vector<std::string>& assignments) {
    Trace changed = trace;
    return splatscope::error_of([&] { replace_programs(changed, assignments); });
  };
  expect_start(error_of({"splat_ewa.vs"}), "--program: \"splat_ewa.vs\", expected NAME=FILE");
  expect_start(error_of({"none.vs=" + written("fine.vs", "vs_1_1\nmov oPos, v0\n")}),
               "--program: no program \"none.vs\", expected one of ");
  expect_start(error_of({"splat_ewa.vs=/no/such/file.vs"}), "/no/such/file.vs: ");
  const std::string wrong = written("wrong.vs", "vs_1_1\nmov oPos, v99\n");
  EXPECT_EQ(error_of({"splat_ewa.vs=" + wrong}), wrong + ":2:1: v99 does not exist, expected v0 to v15");
  const std::string pixel = written("pixel.ps", "ps_1_1\nmov r0, v0\n");
  EXPECT_EQ(error_of({"splat_ewa.vs=" + pixel}),
            pixel + ": a pixel program, expected a vertex program in the place of splat_ewa.vs");
  EXPECT_EQ(error_of({"splat.ps=" + pixel, "splat.ps=" + pixel}),
            "--program: \"splat.ps\" is given twice, expected one file for it");
}

}  // namespace
}  // namespace splatscope::studies
