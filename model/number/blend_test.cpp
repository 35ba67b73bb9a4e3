#include "model/number/blend.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "model/testing/oracle.h"

namespace splatscope {
namespace {

using nlohmann::json;

const std::map<std::string, BlendFactor> kFactors = {
    {"0", BlendFactor::zero},
    {"1", BlendFactor::one},
    {"srcRGB", BlendFactor::src_color},
    {"1-srcRGB", BlendFactor::inv_src_color},
    {"srcA", BlendFactor::src_alpha},
    {"1-srcA", BlendFactor::inv_src_alpha},
    {"dstA", BlendFactor::dst_alpha},
    {"1-dstA", BlendFactor::inv_dst_alpha},
    {"dstRGB", BlendFactor::dst_color},
    {"1-dstRGB", BlendFactor::inv_dst_color},
    {"srcAsat", BlendFactor::src_alpha_saturate},
    {"cRGB", BlendFactor::constant_color},
    {"1-cRGB", BlendFactor::inv_constant_color},
    {"cA", BlendFactor::constant_alpha},
    {"1-cA", BlendFactor::inv_constant_alpha},
};

const std::map<std::string, BlendEquation> kEquations = {
    {"ADD", BlendEquation::add},
    {"SUB", BlendEquation::subtract},
    {"REVSUB", BlendEquation::reverse_subtract},
    {"MIN", BlendEquation::min},
    {"MAX", BlendEquation::max},
};

TEST(Blend, MatchesTheScreensOfAnNv2a) {
  const json vectors = oracle("blend.json");
  ASSERT_FALSE(vectors["cases"].empty());
  for (const json& test : vectors["cases"]) {
    const BlendState state{kFactors.at(test["sf"]), kFactors.at(test["df"]), kEquations.at(test["eq"]),
                           test["constant"].get<Color8>()};
    EXPECT_EQ(blend_unorm8(state, test["src"].get<Color8>(), test["dst"].get<Color8>()),
              test["out"].get<Color8>())
        << test;
  }
}

TEST(Blend, ReplacingAndAddingAreExact) {
  for (int value = 0; value < 256; ++value) {
    const auto v = static_cast<std::uint8_t>(value);
    const Color8 source{v, v, v, v}, destination{7, 7, 7, 7};
    EXPECT_EQ(blend_unorm8({}, source, destination), source);
    const auto sum = static_cast<std::uint8_t>(std::min(255, value + 7));
    EXPECT_EQ(blend_unorm8({BlendFactor::one, BlendFactor::one, BlendEquation::add, {}}, source, destination),
              (Color8{sum, sum, sum, sum}));
  }
}

}  // namespace
}  // namespace splatscope
