#include "model/isa/validate.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "model/error.h"
#include "model/isa/tokens.h"

namespace splatscope::isa {
namespace {

using nlohmann::json;

json oracle(const std::string& name) {
  return json::parse(std::ifstream(std::string(SPLATSCOPE_SOURCE "/tests/oracle/") + name));
}

std::string error_of(const std::string& text) {
  try {
    load(text, "p");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Validate, EveryInvalidProgramOfTheOracleIsRejected) {
  const json vectors = oracle("invalid_programs.json");
  ASSERT_FALSE(vectors["cases"].empty());
  for (const json& test : vectors["cases"])
    EXPECT_NE(error_of(test["program"]), "accepted") << test["program"] << test["why"];
}

TEST(Validate, EveryRunnableProgramOfTheOracleIsAccepted) {
  for (const char* name : {"vertex_programs.json", "pixel_programs.json"}) {
    const json vectors = oracle(name);
    ASSERT_FALSE(vectors["cases"].empty());
    for (const json& test : vectors["cases"])
      EXPECT_EQ(error_of(test["program"]), "accepted") << test["program"];
  }
}

TEST(Validate, DefinitionsPrecedeTheInstructions) {
  EXPECT_EQ(error_of("vs_1_1\nmov r0, v0\ndef c0, 1, 1, 1, 1\nadd oPos, r0, c0\n"),
            "p:3:1: def must precede the instructions");
  EXPECT_EQ(error_of("ps_1_4\nmov r0, c0\n\n  def c0, 1, 1, 1, 1\n"),
            "p:4:3: def must precede the instructions");
  EXPECT_EQ(error_of("ps_1_1\ndef c0, 1, 1, 1, 1\ndef c1, 0, 0, 0, 0\nadd r0, c0, c1\n"), "accepted");
  EXPECT_EQ(error_of("vs_1_1\ndcl_position v0\ndef c0, 1, 1, 1, 1\nmul oPos, v0, c0\n"), "accepted");
}

// Text and tokens break the same rules; the tokens' places are lines of their disassembly.
TEST(Validate, TokensAreCheckedLikeText) {
  const json vectors = oracle("invalid_programs.json");
  for (const json& test : vectors["cases"]) {
    std::string from_text, from_tokens = "accepted";
    std::vector<std::uint32_t> tokens;
    try {
      const Program program = assemble(test["program"].get<std::string>(), "p");
      tokens = write_tokens(program);
      from_text = error_of(disassemble(program));
    } catch (const UserError&) {
      continue;  // what has no tokens, such as an unknown instruction
    }
    try {
      validate(read_tokens(tokens, "p"));
    } catch (const UserError& error) {
      from_tokens = error.what();
    }
    EXPECT_EQ(from_tokens.substr(from_tokens.rfind(": ")), from_text.substr(from_text.rfind(": ")))
        << test["program"];
  }
}

}  // namespace
}  // namespace splatscope::isa
