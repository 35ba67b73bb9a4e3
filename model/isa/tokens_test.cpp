#include "model/isa/tokens.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <string>

#include "model/error.h"
#include "model/isa/validate.h"
#include "model/testing/error_of.h"
#include "model/testing/oracle.h"
#include "model/testing/random_seed.h"

namespace splatscope::isa {
namespace {

using nlohmann::json;
using Tokens = std::vector<std::uint32_t>;

Tokens tokens_of(const json& hex) {
  Tokens tokens;
  for (const std::string token : hex)
    tokens.push_back(static_cast<std::uint32_t>(std::stoul(token, nullptr, 16)));
  return tokens;
}

// Of every oracle that gives tokens with a text.
std::vector<json> cases_with_tokens() {
  std::vector<json> cases;
  for (const char* name : {"bytecode.json", "vertex_programs.json", "pixel_programs.json"}) {
    const json vectors = oracle(name);
    cases.insert(cases.end(), vectors["cases"].begin(), vectors["cases"].end());
  }
  return cases;
}

TEST(Tokens, AreThoseOfAnIndependentAssembler) {
  const std::vector<json> cases = cases_with_tokens();
  ASSERT_EQ(cases.size(), 147u + 118u + 212u);
  for (const json& test : cases)
    EXPECT_EQ(write_tokens(assemble(test["program"].get<std::string>(), "case")), tokens_of(test["tokens"]))
        << test["program"];
}

TEST(Tokens, ComeBackFromTheirDisassembly) {
  for (const json& test : cases_with_tokens()) {
    const Tokens tokens = tokens_of(test["tokens"]);
    const Program program = read_tokens(tokens, "case");
    EXPECT_EQ(write_tokens(program), tokens) << test["program"];
    const std::string text = disassemble(program);
    EXPECT_EQ(write_tokens(assemble(text, "case")), tokens) << text;
    EXPECT_EQ(disassemble(assemble(text, "case")), text);
  }
}

TEST(Tokens, OfScalarsCarryTheWholeMask) {
  for (const char* mask : {"", ".x", ".y", ".z", ".w"}) {
    const std::string text = std::string("vs_1_1\nmov oFog") + mask + ", v0.x\nmov oPts" + mask + ", v0.x\n";
    const Tokens tokens = write_tokens(assemble(text, "a"));
    EXPECT_EQ(tokens[2], 0xc00f0001u) << text;
    EXPECT_EQ(tokens[5], 0xc00f0002u) << text;
  }
}

// Which component a scalar was given is lost in its tokens: a program whose text is valid stays so.
TEST(Tokens, OfAScalarThatReadsOneComponentAreValid) {
  const char* const start = "vs_1_1\nmov oPos, v0\nmov r0.z, v0.z\n";
  for (const char* end : {"mov oFog.z, r0\n", "mov oPts.z, r0\n", "mul oFog.z, r0, v0\n"}) {
    Program program = read_tokens(write_tokens(assemble(std::string(start) + end, "a")), "a");
    EXPECT_NO_THROW(validate(program)) << end;
  }
  for (const char* end :
       {"mov oFog, r1\n", "dp3 oFog, r0, v0\n", "mov oFog, r0.x\n", "mov r1.x, v0.x\nmul oFog, r0, r1\n"})
    EXPECT_THROW(validate(assemble(std::string(start) + end, "a")), UserError) << end;
}

// What is a colour before ps_1_4 has the letters of one.
TEST(Tokens, ComponentsOfTexturesAreNamedByWhatTheyHold) {
  for (const char* text : {"ps_1_1\ntex t0\nmov r0, t0.a\n", "ps_1_4\ntexcrd r0.rgb, t0.xyz\nmov r0, c0\n"}) {
    const std::string again = disassemble(assemble(text, "a"));
    EXPECT_EQ(again, disassemble(assemble(again, "b")));
    EXPECT_NE(again.find(text[5] == '1' ? "t0.a" : "t0.xyz"), std::string::npos) << again;
  }
}

TEST(Tokens, PlacesAreLinesOfTheDisassembly) {
  const Program program =
      assemble("vs_1_1\n\ndef c0, 0.1, -0, 1e-30, 16777216\nmov r0, c0\n\n  mov oPos, r0\n", "a");
  const Program read = read_tokens(write_tokens(program), "a");
  EXPECT_EQ(disassemble(read), "vs_1_1\ndef c0, 0.1, -0, 1e-30, 16777216\nmov r0, c0\nmov oPos, r0\n");
  EXPECT_EQ(read.instructions[1].line, 4);
}

TEST(Tokens, CommentsAreSkipped) {
  const Tokens tokens{0xfffe0101, 0x0002fffe, 0x12345678, 0x0000ffff,
                      0x00000001, 0xc00f0000, 0x90e40000, 0x0000ffff};
  EXPECT_EQ(disassemble(read_tokens(tokens, "a")), "vs_1_1\nmov oPos, v0\n");
}

std::string error_of(const Tokens& tokens) {
  return splatscope::error_of([&] { read_tokens(tokens, "a.vso"); });
}

TEST(Tokens, HostileStreamsAreErrors) {
  EXPECT_EQ(error_of({}), "a.vso:1:1: the tokens end, expected a version (token 0)");
  EXPECT_EQ(error_of({0xfffe0200}),
            "a.vso:1:1: fffe0200 is not a version, expected vs_1_1 (fffe0101) or ps_1_1 to ps_1_4 "
            "(ffff0101 to ffff0104) (token 0)");
  EXPECT_EQ(error_of({0xfffe0101, 1, 0xc00f0000}), "a.vso:2:1: the tokens end, expected a source (token 2)");
  EXPECT_EQ(error_of({0xfffe0101}), "a.vso:1:1: the tokens end, expected an end token (0000ffff) (token 0)");
  EXPECT_EQ(error_of({0xfffe0101, 0x7ffffffe}),
            "a.vso:1:1: a comment goes past the end of the tokens (token 1)");
  EXPECT_EQ(error_of({0xfffe0101, 0x00001234}),
            "a.vso:2:1: 00001234 is not an instruction of vs_1_1 (token 1)");
  EXPECT_EQ(error_of({0xfffe0101, 0x0000ffff, 0}), "a.vso:1:1: tokens follow the end token (token 1)");
}

// Bits of valid streams flipped, cut and repeated: an error or a program, never a crash; and what is read can
// be written.
TEST(Tokens, MutatedStreamsAreErrorsOrPrograms) {
  std::mt19937 random(random_seed());
  const std::vector<json> cases = cases_with_tokens();
  int accepted = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Tokens tokens = tokens_of(cases[random() % cases.size()]["tokens"]);
    for (unsigned flips = random() % 4; flips > 0; --flips)
      tokens[random() % tokens.size()] ^= 1u << random() % 32;
    if (random() % 8 == 0) tokens.resize(random() % tokens.size());
    try {
      const Program program = read_tokens(tokens, "mutated");
      const Tokens written = write_tokens(program);
      EXPECT_EQ(write_tokens(assemble(disassemble(program), "again")), written) << disassemble(program);
      // oFog and oPts are scalars: one component is written as the whole mask.
      const std::string text = disassemble(program);
      const bool scalar_mask = std::regex_search(text, std::regex("o(Fog|Pts)\\.[xyzw],"));
      const bool comment = written.size() < tokens.size();  // skipped, so not written
      EXPECT_TRUE(scalar_mask || comment || written == tokens) << text;
      ++accepted;
      validate(program);
    } catch (const UserError&) {
    }
  }
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace splatscope::isa
