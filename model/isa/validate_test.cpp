#include "model/isa/validate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "model/error.h"
#include "model/isa/tokens.h"
#include "model/testing/error_of.h"
#include "model/testing/oracle.h"

namespace splatscope::isa {
namespace {

using nlohmann::json;

std::string error_of(const std::string& text) {
  return splatscope::error_of([&] { load(text, "p"); });
}

TEST(Validate, EveryInvalidProgramOfTheOracleIsRejected) {
  const json vectors = oracle("invalid_programs.json");
  ASSERT_FALSE(vectors["cases"].empty());
  for (const json& test : vectors["cases"])
    EXPECT_NE(error_of(test["program"]), "no error") << test["program"] << test["why"];
}

TEST(Validate, EveryRunnableProgramOfTheOracleIsAccepted) {
  for (const char* name : {"vertex_programs.json", "pixel_programs.json"}) {
    const json vectors = oracle(name);
    ASSERT_FALSE(vectors["cases"].empty());
    for (const json& test : vectors["cases"])
      EXPECT_EQ(error_of(test["program"]), "no error") << test["program"];
  }
}

TEST(Validate, DefinitionsPrecedeTheInstructions) {
  EXPECT_EQ(error_of("vs_1_1\nmov r0, v0\ndef c0, 1, 1, 1, 1\nadd oPos, r0, c0\n"),
            "p:3:1: def must precede the instructions");
  EXPECT_EQ(error_of("ps_1_4\nmov r0, c0\n\n  def c0, 1, 1, 1, 1\n"),
            "p:4:3: def must precede the instructions");
  EXPECT_EQ(error_of("ps_1_1\ndef c0, 1, 1, 1, 1\ndef c1, 0, 0, 0, 0\nadd r0, c0, c1\n"), "no error");
  EXPECT_EQ(error_of("vs_1_1\ndcl_position v0\ndef c0, 1, 1, 1, 1\nmul oPos, v0, c0\n"), "no error");
}

TEST(Validate, DeclarationsPrecedeTheInstructions) {
  EXPECT_EQ(error_of("vs_1_1\nmov oPos, v0\ndcl_normal v1\n"), "p:3:1: dcl must precede the instructions");
}

TEST(Validate, WhatHasBecomeTheDepthIsNoRegister) {
  EXPECT_EQ(error_of("ps_1_4\ntexcrd r5.rgb, t0\nphase\ntexdepth r5\nmov r5, c0\nmov r0, c0\n"),
            "p:5:1: r5 cannot be used after texdepth");
  EXPECT_EQ(error_of("ps_1_4\ntexcrd r5.rgb, t0\nphase\ntexdepth r5\ntexld r5, t0\nmov r0, c0\n"),
            "p:5:1: r5 cannot be used after texdepth");
  EXPECT_EQ(error_of("ps_1_3\ntex t0\ntexm3x2pad t1, t0\ntexm3x2depth t2, t0\nmov t2, v0\nmov r0, v0\n"),
            "p:5:1: t2 cannot be used after texm3x2depth");
  EXPECT_EQ(error_of("ps_1_3\ntex t0\ntexm3x2pad t1, t0\ntexm3x2depth t2, t0\nmov t3, v0\nmov r0, t3\n"),
            "no error");
}

// A program without a marker is all second phase.
TEST(Validate, FragmentsAreKilledInTheSecondPhase) {
  EXPECT_EQ(error_of("ps_1_4\ntexkill t0\nphase\nmov r0, v0\n"), "p:2:1: texkill stands in the second phase");
  EXPECT_EQ(error_of("ps_1_4\ntexcrd r1.rgb, t0\ntexkill r1\nphase\nmov r0, v0\n"),
            "p:3:1: texkill stands in the second phase");
  EXPECT_EQ(error_of("ps_1_4\nphase\ntexkill t0\nmov r0, v0\n"), "no error");
  EXPECT_EQ(error_of("ps_1_4\ntexkill t0\nmov r0, v0\n"), "no error");
  EXPECT_EQ(error_of("ps_1_1\ntexkill t0\nmov r0, v0\n"), "no error");
}

TEST(Validate, BemPerturbsByATemporary) {
  EXPECT_EQ(error_of("ps_1_4\nbem r1.rg, c0, c1\nphase\nmov r0, v0\n"),
            "p:2:1: the second source of bem is r#");
  EXPECT_EQ(error_of("ps_1_4\ntexld r2, t0\nbem r1.rg, c0, -r2_bx2\nphase\nmov r0, v0\n"), "no error");
}

// "The positions of the instructions are required to be in order" (DirectX 8, "Pixel Shader Texture
// Addressing").
TEST(Validate, TextureAddressesGoByTheirStages) {
  EXPECT_EQ(
      error_of("ps_1_1\ntex t1\ntex t0\nmov r0, t0\n"),
      "p:3:1: t0 after t1: texture address instructions stand in the order of their stages, one a stage "
      "before ps_1_4");
  EXPECT_NE(error_of("ps_1_1\ntex t0\ntex t0\nmov r0, t0\n"), "no error");
  EXPECT_NE(error_of("ps_1_3\ntex t0\ntexkill t0\nmov r0, t0\n"), "no error");
  EXPECT_NE(error_of("ps_1_2\ntex t0\ntexbem t1, t0\ntexbem t1, t0\nmov r0, t1\n"), "no error");
  EXPECT_EQ(error_of("ps_1_1\ntex t0\ntex t2\nmov r0, t2\n"), "no error");
  EXPECT_EQ(error_of("ps_1_4\ntexld r1, t1\ntexld r0, t0\nmov r0, r1\n"), "no error");
}

TEST(Validate, APhaseHasSixTextureAddressInstructions) {
  std::string kills;
  for (int i = 0; i < 6; ++i) kills += fmt::format("texkill t{}\n", i % 2);
  const std::string end = "mov r0, v0\n";
  EXPECT_EQ(error_of("ps_1_4\n" + kills + end), "no error");
  EXPECT_EQ(error_of("ps_1_4\n" + kills + "texkill t0\n" + end),
            "p:8:1: more than 6 texture address instructions in a phase");
  EXPECT_EQ(error_of("ps_1_4\ntexld r0, t0\nphase\n" + kills + end), "no error");
}

TEST(Validate, TexcrdWritesTwoComponentsByDwOnly) {
  EXPECT_EQ(error_of("ps_1_4\ntexcrd r0.rg, t0\nmov r0, v0\n"),
            "p:2:1: texcrd writes .rgb, or .rg with _dw, never the fourth component");
  EXPECT_EQ(error_of("ps_1_4\ntexcrd r0.rg, t0_dw.xyw\nmov r0, v0\n"), "no error");
  EXPECT_NE(error_of("ps_1_4\ntexcrd r0.rgb, t0_dw.xyw\nmov r0, v0\n"), "no error");
}

TEST(Validate, MacrosWriteTheirComponents) {
  EXPECT_EQ(error_of("vs_1_1\nm4x4 r0.xyz, v0, c0\nmov oPos, v0\n"),
            "p:2:1: this macro needs the write mask .xyzw");
  EXPECT_EQ(error_of("vs_1_1\nmov oPos, v0\nm4x4 oFog, v0, c0\n"),
            "p:3:1: oFog and oPts are scalars, a macro writes several components");
}

TEST(Validate, ReadsOfTextureRegistersNeedTheirComponents) {
  EXPECT_EQ(error_of("ps_1_1\nmov t1.a, v0\nmov r0, t1\n"),
            "p:3:1: t1 is read before it is written (all the components read)");
  EXPECT_EQ(error_of("ps_1_1\nmov t1.a, v0\nmov t1.rgb, v0\nmov r0, t1\n"), "no error");
}

// Either half may write a t#; both count once the pair is over.
TEST(Validate, BothHalvesOfAPairWrite) {
  EXPECT_EQ(error_of("ps_1_1\ntex t0\nmov r0.rgb, v0\n+ mov t0.a, v0\nmov r0.a, t0\n"), "no error");
  EXPECT_EQ(error_of("ps_1_1\ntex t0\nmov t0.a, v0\n+ mov r0.rgb, v0\nmov r0.a, t0\n"), "no error");
  EXPECT_EQ(error_of("ps_1_1\nmov t1.rgb, v0\n+ mov r0.a, t1\nmov r0.rgb, t1\n"),
            "p:3:3: t1 is read before it is written (all the components read)");
}

TEST(Validate, BothHalvesOfAPairTakeSlots) {
  std::string moves = "ps_1_2\n";
  for (int i = 0; i < 7; ++i) moves += "mov r1, v0\n";
  EXPECT_NE(error_of(moves + "mov r0.rgb, v0\n+ cmp r0.a, r1, v0, v1\n"), "no error");
  EXPECT_NE(error_of(moves + "cmp r0.a, r1, v0, v1\n+ mov r0.rgb, v0\n"), "no error");
  EXPECT_EQ(error_of(moves + "mov r0.rgb, v0\n+ mov r0.a, v1\n"), "no error");
}

TEST(Validate, DependentReadsAreOfTheFirstPhase) {
  EXPECT_EQ(
      error_of("ps_1_4\ntexcrd r0.rgb, t0\nphase\ntexld r0, t1\ntexld r1, r0\nmov r0, r1\n"),
      "p:5:1: texld reads r0 as the first phase left it: not all that is read of it was written there, or "
      "it is written again before");
  EXPECT_EQ(error_of("ps_1_4\ntexcrd r0.rgb, t0\nphase\ntexld r0, r0\nmov r0, r0\n"), "no error");
}

// Out of range a constant reads as 0, so where the rows of a relative matrix lie is no matter.
TEST(Validate, RowsOfARelativeMatrixMayReachPastTheLastConstant) {
  EXPECT_EQ(error_of("vs_1_1\nmov a0.x, v1.x\nm4x4 oPos, v0, c[a0.x + 95]\n"), "no error");
  EXPECT_EQ(error_of("vs_1_1\nm4x4 oPos, v0, c93\n"), "p:2:1: c96 does not exist, expected c0 to c95");
}

TEST(Validate, EveryRuleIsNamedWithItsPlace) {
  const struct {
    const char *program, *error;
  } cases[] = {
      {"vs_1_1\ndcl_position r0\nmov oPos, v0\n", "p:2:14: dcl declares an input, expected v#"},
      {"ps_1_1\nmul_x3 r0, v0, v1\n",
       "p:2:1: '_x3' is not a modifier here, expected one of _x2 _x4 _x8 _d2 _d4 _d8, then _sat"},
      {"ps_1_4\nmov r0, -t0_dz\n", "p:2:10: '_dz' cannot be combined with negation"},
      {"vs_1_1\nadd a0.x, v0.x, v0.x\nmov oPos, v0\n", "p:2:1: only mov writes the address register"},
      {"vs_1_1\nm4x4 oPos, c0, c0\n",
       "p:2:1: this macro reads two different registers of one file with one read port"},
      {"vs_1_1\nm4x4 oPos, v0, v0\n",
       "p:2:1: this macro reads two different registers of one file with one read port"},
      {"ps_1_1\ntex t0\ntexm3x2pad t1, t0\nmov r0, v0\n",
       "p:4:1: a texm3x2pad or texm3x3pad lacks its last row"},
      {"ps_1_4\ntexcrd r0.rgb, t0\ntexcrd r1.rgb, t1\ntexcrd r2.rgb, t2\nphase\ntexld r3, r0_dz\ntexld r4, "
       "r1_dz\ntexld r5, r2_dz\nmov r0, r3\n",
       "p:8:1: a program uses _dz at most twice"},
      {"ps_1_1\ntex t0\ntexreg2ar t1, t1\nmov r0, t1\n",
       "p:3:1: the source of a texture address instruction is of an earlier stage than its destination"},
      {"ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3spec t3, t0, v0\nmov r0, t3\n",
       "p:5:1: the eye ray of texm3x3spec is a constant c# without modifiers"},
      {"ps_1_1\nmov r0.rgb, v0\n+ dp3 r0.a, v0, v1\n",
       "p:3:3: dp3 runs in the colour pipe: it cannot be the alpha half of a pair"},
      {"vs_1_1\ndef c96, 0, 0, 0, 0\nmov oPos, v0\n", "p:2:1: c96 does not exist, expected c0 to c95"},
      {"vs_1_1\nmov r0, v0\nm4x4 r0, r0, c0\nmov oPos, r0\n",
       "p:3:1: the destination of a macro cannot be one of its sources"},
      {"ps_1_1\ndcl_position v0\nmov r0, v0\n", "p:2:1: dcl is of vertex programs"},
      {"ps_1_4\ntexld r2, t0\nbem r0.rg, c0, r2\nbem r1.rg, c0, r2\nphase\nmov r0, v0\n",
       "p:4:1: a program has at most one bem"},
      {"ps_1_1\nmov r0, v0\ndp3 r0.a, v0, v1\n", "p:3:1: dp3 writes .rgb or .rgba before ps_1_4"},
      {"ps_1_4\ntexcrd r5.rgb, t0\ntexdepth r5\nphase\nmov r0, v0\n",
       "p:3:1: texdepth takes r5, in the second phase"},
      {"ps_1_1\ntex t0\nmov r0.rgb, v0\n+ mov_x8 r0.a, v0\n", "p:4:3: _x8, _d4 and _d8 need ps_1_4"},
  };
  for (const auto& [program, error] : cases) EXPECT_EQ(error_of(program), error) << program;
}

// Text and tokens break the same rules; the tokens' places are lines of their disassembly.
TEST(Validate, TokensAreCheckedLikeText) {
  const json vectors = oracle("invalid_programs.json");
  for (const json& test : vectors["cases"]) {
    std::string from_text;
    std::vector<std::uint32_t> tokens;
    try {
      const Program program = assemble(test["program"].get<std::string>(), "p");
      tokens = write_tokens(program);
      from_text = error_of(disassemble(program));
    } catch (const UserError&) {
      continue;  // what has no tokens, such as an unknown instruction
    }
    const std::string from_tokens = splatscope::error_of([&] { validate(read_tokens(tokens, "p")); });
    EXPECT_EQ(from_tokens.substr(from_tokens.rfind(": ")), from_text.substr(from_text.rfind(": ")))
        << test["program"];
  }
}

}  // namespace
}  // namespace splatscope::isa
