// The vectors of tests/oracle: one instruction at a time, and whole programs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/testing/oracle.h"
#include "model/vertex/vertex_program.h"

namespace splatscope::vertex {
namespace {

using nlohmann::json;

std::vector<std::string> hex_of(const Vec4& value) {
  std::vector<std::string> hex;
  for (const float component : value)
    hex.push_back(fmt::format("{:08x}", std::bit_cast<std::uint32_t>(component)));
  return hex;
}

struct Run {
  std::vector<Vec4> constants;
  std::unique_ptr<InputBatch> in = std::make_unique<InputBatch>();
  std::unique_ptr<OutputBatch> out = std::make_unique<OutputBatch>();

  Run() {
    for (auto& input : in->v) std::fill_n(input[3], kBatch, 1.0f);
  }
  void set_constant(std::size_t index, const Vec4& value) {
    constants.resize(std::max(constants.size(), index + 1));
    constants[index] = value;
  }
  void set_input(std::size_t index, const Vec4& value) {
    for (std::size_t c = 0; c < 4; ++c) std::fill_n(in->v[index][c], kBatch, value[c]);
  }
  // By the SIMD code; the scalar interpreter must agree in every bit of every output.
  Vec4 operator()(const VertexProgram& program, Output output) {
    const auto scalar = std::make_unique<OutputBatch>();
    program.run(constants, *in, *out, kBatch);
    program.run_scalar(constants, *in, *scalar, kBatch);
    for (int o = 0; o < kOutputs; ++o)
      for (int c = 0; c < 4; ++c)
        for (int lane = 0; lane < kBatch; ++lane)
          EXPECT_EQ(std::bit_cast<std::uint32_t>(out->o[o][c][lane]),
                    std::bit_cast<std::uint32_t>(scalar->o[o][c][lane]));
    const auto& values = out->o[output];
    return {values[0][0], values[1][0], values[2][0], values[3][0]};
  }
};

Vec4 run_operation(const json& test, Arithmetic arithmetic) {
  const std::string op = test["op"];
  const bool scalar =
      op == "rcp" || op == "rsq" || op == "exp" || op == "expp" || op == "log" || op == "logp";
  std::string text = "vs_1_1\nmov r2, v1\n" + op + " oT0, v0" + (scalar ? ".x" : "");
  if (test["in"].size() > 1) text += ", c0";
  if (test["in"].size() > 2) text += ", r2";
  const VertexProgram program(isa::assemble(text, "case"), arithmetic);
  Run run;
  run.set_input(0, vector_of(test["in"][0]));
  if (test["in"].size() > 1) run.set_constant(0, vector_of(test["in"][1]));
  if (test["in"].size() > 2) run.set_input(1, vector_of(test["in"][2]));
  return run(program, oT0);
}

TEST(VertexOracle, InstructionsInIeee) {
  int compared = 0;
  const json vectors = oracle("vertex_ops.json");
  for (const json& test : vectors["cases"]) {
    if (test["ieee"].is_null()) continue;
    EXPECT_EQ(hex_of(run_operation(test, Arithmetic::ieee)), test["ieee"].get<std::vector<std::string>>())
        << test;
    ++compared;
  }
  EXPECT_EQ(compared, 1775);
}

TEST(VertexOracle, InstructionsOfTheNv20BitForBit) {
  const json vectors = oracle("vertex_ops.json");
  ASSERT_EQ(vectors["cases"].size(), 1776u);
  for (const json& test : vectors["cases"])
    EXPECT_EQ(hex_of(run_operation(test, Arithmetic::nv20)), test["nv20"].get<std::vector<std::string>>())
        << test;
}

// exp and log are macros of Direct3D, which the vectors leave out: on an NV20 they are the correct result
// with its one NaN, and without denormals on the way in or out.
TEST(VertexOracle, ExponentAndLogarithmOfTheNv20KeepItsNumbers) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const auto result = [](const char* operation, float argument) {
    const json test{{"op", operation}, {"in", json::array({hex_of({argument, 0, 0, 0})})}};
    return hex_of(run_operation(test, Arithmetic::nv20))[0];
  };
  const auto hex = [](float value) { return hex_of({value, 0, 0, 0})[0]; };
  EXPECT_EQ(result("log", 8.0f), hex(3.0f));
  EXPECT_EQ(result("log", -0.25f), hex(-2.0f));
  EXPECT_EQ(result("log", 0x1p-126f), hex(-126.0f));
  EXPECT_EQ(result("log", 0x1p-127f), hex(-kInfinite));
  EXPECT_EQ(result("log", std::numeric_limits<float>::quiet_NaN()), "7fffffff");
  EXPECT_EQ(result("exp", 3.0f), hex(8.0f));
  EXPECT_EQ(result("exp", -126.0f), hex(0x1p-126f));
  EXPECT_EQ(result("exp", -126.5f), hex(0.0f));
  EXPECT_EQ(result("exp", 128.0f), hex(kInfinite));
}

// Programs' vectors: constants and inputs, the rest 0 (inputs: 0,0,0,1).
Vec4 run_program(const json& test, const isa::Program& program, Arithmetic arithmetic) {
  Run run;
  for (const auto& [name, value] : test["constants"].items())
    run.set_constant(std::stoul(name.substr(1)), vector_of(value));
  for (const auto& [name, value] : test["inputs"].items())
    run.set_input(std::stoul(name.substr(1)), vector_of(value));
  const std::string output = test["output"];
  const Output place =
      output == "oPos" ? oPos : static_cast<Output>((output[1] == 'D' ? oD0 : oT0) + (output[2] - '0'));
  return run(VertexProgram(program, arithmetic), place);
}

// Its ieee results come from another implementation's exp2 and log2, and have been rounded to single once
// more.
TEST(VertexOracle, ProgramsInIeee) {
  const json vectors = oracle("vertex_programs.json");
  ASSERT_FALSE(vectors["cases"].empty());
  for (const json& test : vectors["cases"]) {
    const isa::Program program = isa::load(test["program"].get<std::string>(), "case");
    const Vec4 result = run_program(test, program, Arithmetic::ieee);
    const Vec4 expected = vector_of(test["ieee"]);
    for (std::size_t i = 0; i < 4; ++i) {
      if (std::isnan(expected[i]) || std::isinf(expected[i]))
        EXPECT_EQ(hex_of(result)[i], hex_of(expected)[i]) << test;
      else
        EXPECT_NEAR(result[i], expected[i], std::fabs(expected[i]) * 0x1p-21f + 1e-30f) << test;
    }
  }
}

TEST(VertexOracle, ProgramsOfTheNv20BitForBit) {
  const json vectors = oracle("vertex_programs.json");
  ASSERT_FALSE(vectors["cases"].empty());
  for (const json& test : vectors["cases"])
    EXPECT_EQ(
        hex_of(run_program(test, isa::load(test["program"].get<std::string>(), "case"), Arithmetic::nv20)),
        test["nv20"].get<std::vector<std::string>>())
        << test;
}

}  // namespace
}  // namespace splatscope::vertex
