#include "studies/shader_batch.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "model/error.h"

namespace splatscope::studies {
namespace {

using nlohmann::json;

std::string run(const std::string& text, Arithmetic arithmetic = Arithmetic::ieee) {
  return run_shader_case(text, arithmetic, "cases.jsonl", 7);
}

TEST(ShaderBatch, GivesEveryOutputThatTheProgramWrites) {
  EXPECT_EQ(run(R"({"id": "a", "program": "vs_1_1\nmov oPos, v0\nmov oT0.xy, c1\n",
                    "constants": {"c1": ["3f800000", "40000000", "0", "0"]}, "inputs": {"v0": ["3f800000", "0", "0", "bf800000"]}})"),
            R"({"id":"a","outputs":{"oPos":["3f800000","00000000","00000000","bf800000"],)"
            R"("oT0":["3f800000","40000000","00000000","00000000"]}})");
}

TEST(ShaderBatch, WhatIsNotGivenIsZeroAndInputsEndInOne) {
  EXPECT_EQ(run(R"({"id": 1, "program": "vs_1_1\nadd oPos, v3, c95\n"})"),
            R"({"id":1,"outputs":{"oPos":["00000000","00000000","00000000","3f800000"]}})");
}

TEST(ShaderBatch, TokensAndPixelPrograms) {
  EXPECT_EQ(run(R"({"id": "t", "tokens": ["fffe0101", "1", "c00f0000", "90e40000", "0000ffff"]})"),
            R"({"id":"t","outputs":{"oPos":["00000000","00000000","00000000","3f800000"]}})");
  EXPECT_EQ(
      run(R"({"id": "p", "program": "ps_1_1\ntex t0\nmul r0, t0, v0\n", "inputs": {"v0": ["3f000000", "0", "0", "3f800000"]},
                    "textures": {"t0": ["3f000000", "3f800000", "0", "3e800000"]}})"),
      R"({"id":"p","outputs":{"r0":["3e800000","00000000","00000000","3e800000"]}})");
  EXPECT_EQ(
      run(R"({"id": "k", "program": "ps_1_4\ntexcrd r5.rgb, t0\nphase\ntexkill t1\ntexdepth r5\nmov r0, c0\n",
                    "texcoords": {"t0": ["3f000000", "3f800000", "0", "0"], "t1": ["0", "bf800000", "0", "0"]}})"),
      R"({"id":"k","outputs":{"r0":["00000000","00000000","00000000","00000000"],"depth":["3f000000"],"killed":true}})");
}

TEST(ShaderBatch, AProgramThatDoesNotLoadIsAnErrorWithItsLine) {
  EXPECT_EQ(run(R"({"id": "b", "program": "vs_1_1\nmov oPos, q0\n"})"),
            R"({"id":"b","error":"2: column 11: 'q0' is not a register of vs_1_1"})");
  EXPECT_EQ(run(R"({"id": "b", "tokens": []})"),
            R"x({"id":"b","error":"1: column 1: the tokens end, expected a version (token 0)"})x");
}

std::string error_of(const std::string& text) {
  try {
    return run(text);
  } catch (const UserError& error) {
    return error.what();
  }
}

TEST(ShaderBatch, ACaseThatIsNoneIsAUserError) {
  EXPECT_EQ(error_of("[1]"), "cases.jsonl:7: this is no JSON object, expected a case");
  EXPECT_EQ(error_of(R"({"id": "a"})"), "cases.jsonl:7: expected \"program\" or \"tokens\"");
  EXPECT_EQ(error_of(R"({"prgram": ""})").substr(0, 36), "cases.jsonl:7: unknown key \"prgram\",");
  EXPECT_EQ(error_of(R"({"program": "vs_1_1\nmov oPos, v0", "inputs": {"v16": []}})"),
            "cases.jsonl:7: inputs has \"v16\", expected v0 to v15");
  EXPECT_EQ(error_of(R"({"program": "vs_1_1\nmov oPos, v0", "inputs": {"v0": ["x", "0", "0", "0"]}})"),
            "cases.jsonl:7: v0 is \"x\", expected 32 bits in hex");
}

TEST(ShaderBatch, TheVectorsOfTheNv20) {
  const json oracle = json::parse(std::ifstream(SPLATSCOPE_SOURCE "/tests/oracle/vertex_programs.json"));
  std::stringstream cases, results;
  for (const json& test : oracle["cases"])
    cases << json{{"id", test["id"]},
                  {"tokens", test["tokens"]},
                  {"constants", test["constants"]},
                  {"inputs", test["inputs"]}}
          << '\n';
  run_shader_batch(cases, "cases", Arithmetic::nv20, results);
  for (const json& test : oracle["cases"]) {
    std::string line;
    ASSERT_TRUE(std::getline(results, line));
    EXPECT_EQ(json::parse(line)["outputs"][test["output"].get<std::string>()], test["nv20"]) << test["id"];
  }
}

}  // namespace
}  // namespace splatscope::studies
