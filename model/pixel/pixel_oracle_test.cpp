// The vectors of tests/oracle/pixel_programs.json.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/pixel/pixel_program.h"
#include "model/testing/oracle.h"

namespace splatscope::pixel {
namespace {

using nlohmann::json;

class PixelOracle : public testing::Test {
 protected:
  Vec4 run(const json& test, CombinerFormat format) {
    const PixelProgram program(isa::load(test["program"].get<std::string>(), "case"), format);
    std::vector<Vec4> constants;
    for (int i = 0; i < 8; ++i) constants.push_back(vector_of(inputs_["constants"][fmt::format("c{}", i)]));
    const auto batch = std::make_unique<FragmentBatch>();
    const auto set = [](Lanes* lanes, const Vec4& value) {
      for (std::size_t c = 0; c < 4; ++c) std::fill_n(lanes[c], kBatch, value[c]);
    };
    set(batch->v0, vector_of(inputs_["v0"]));
    set(batch->v1, vector_of(inputs_["v1"]));
    for (int i = 0; i < 4; ++i) set(batch->t[i], vector_of(inputs_["texcoords"][fmt::format("t{}", i)]));
    const json& textures = inputs_["texture n is 1x1 with value"];
    program.run(constants, *batch, kBatch, [&](int stage, const Lanes*, Lanes* texel, int) {
      set(texel, vector_of(textures[fmt::format("t{}", stage)]));
    });
    return {batch->r0[0][kBatch - 1], batch->r0[1][kBatch - 1], batch->r0[2][kBatch - 1],
            batch->r0[3][kBatch - 1]};
  }

  json vectors_ = oracle("pixel_programs.json");
  json inputs_ = oracle("pixel_inputs.json");
};

// The last bits are those of the other implementation's order of evaluation: 2^-21 is 4 units of a sum of
// terms up to 4.
constexpr float kTolerance = 0x1p-21f;

TEST_F(PixelOracle, WithoutRangesResultsAreTheVectors) {
  ASSERT_EQ(vectors_["cases"].size(), 212u);
  for (const json& test : vectors_["cases"]) {
    const Vec4 result = run(test, CombinerFormat::unbounded);
    const Vec4 ideal = vector_of(test["ideal"]);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(result[i], ideal[i], kTolerance) << test["program"];
      // Rounded to nearest; a tie may fall to either side.
      EXPECT_NEAR(std::clamp(result[i], 0.0f, 1.0f) * 255.0f, test["rgba8"][i].get<float>(), 0.5f + 1e-4f)
          << test["program"];
    }
  }
}

// Programs of one arithmetic instruction have no intermediate: their results are the vectors within the
// range.
TEST_F(PixelOracle, SingleInstructionsKeepToTheRange) {
  int compared = 0;
  for (const json& test : vectors_["cases"]) {
    const isa::Program program = isa::load(test["program"].get<std::string>(), "case");
    const float range = program.version.minor == 4 ? 8.0f : 1.0f;
    const auto arithmetic = std::ranges::count_if(
        program.instructions,
        [](const isa::Instruction& instruction) { return instruction.opcode < isa::Opcode::tex; });
    if (arithmetic != 1) continue;
    ++compared;
    const Vec4 result = run(test, CombinerFormat::float32);
    const Vec4 ideal = vector_of(test["ideal"]);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(result[i], std::clamp(ideal[i], -range, range), kTolerance) << test["program"];
  }
  EXPECT_GT(compared, 80);
}

TEST_F(PixelOracle, NineBitResultsAreSteps) {
  for (const json& test : vectors_["cases"])
    for (const float value : run(test, CombinerFormat::signed9))
      EXPECT_NEAR(value * 255.0f, std::nearbyint(value * 255.0f), 1e-3f) << test["program"];
}

}  // namespace
}  // namespace splatscope::pixel
