#include "studies/shader_batch.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "model/testing/error_of.h"
#include "model/testing/oracle.h"

namespace splatscope::studies {
namespace {

using nlohmann::json;

std::string run(const std::string& text, Arithmetic arithmetic = Arithmetic::ieee) {
  return run_shader_case(text, arithmetic).json;
}

TEST(ShaderBatch, GivesEveryOutputThatTheProgramWrites) {
  EXPECT_EQ(run(R"({"id": "a", "program": "vs_1_1\nmov oPos, v0\nmov oT0.xy, c1\n",
                    "constants": {"c1": ["3f800000", "40000000", "0", "0"]}, "inputs": {"v0": ["3f800000", "0", "0", "bf800000"]}})"),
            R"({"id":"a","outputs":{"oPos":["3f800000","00000000","00000000","bf800000"],)"
            R"("oT0":["3f800000","40000000","00000000","00000000"]}})");
}

TEST(ShaderBatch, EveryOutputIsGivenUnderItsName) {
  const json result = json::parse(
      run(R"({"id": 1, "program": "vs_1_1\nmov oPos, c0.x\nmov oD0, c0.y\nmov oD1, c0.z\nmov oT0, c0.w\n)"
          R"(mov oT1, c1.x\nmov oFog, c1.y\nmov oPts, c1.z\n", "constants": {"c0": ["1", "2", "3", "4"],)"
          R"( "c1": ["5", "6", "7", "8"]}})"));
  const std::pair<const char*, const char*> kOutputs[] = {
      {"oPos", "1"}, {"oD0", "2"}, {"oD1", "3"}, {"oT0", "4"}, {"oT1", "5"}, {"oFog", "6"}, {"oPts", "7"}};
  EXPECT_EQ(result["outputs"].size(), std::size(kOutputs)) << result;
  for (const auto& [name, value] : kOutputs)
    EXPECT_EQ(result["outputs"][name][0], std::string("0000000") + value) << name;
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

// bem: 0.5 + 0.25*0.5 + 0.5*0.25 and 0.25 + 1*0.5 - 1*0.25. texbeml: the texel times 0.25*1 + 0.5.
TEST(ShaderBatch, BumpStagesAreGivenAsTheStateOfAStage) {
  const std::string stage = R"(["3e800000", "3f800000", "3f000000", "bf800000", "3f800000", "3f000000"])";
  EXPECT_EQ(run(R"({"id": 1, "program": "ps_1_4\ntexcrd r0.rgb, t0\ntexcrd r1.rgb, t1\nbem r0.rg, r0, r1\n)"
                R"(phase\nmov r0.rgb, r0\n+ mov r0.a, c0\n", "texcoords": {"t0": ["3f000000", "3e800000",)"
                R"( "0", "0"], "t1": ["3f000000", "3e800000", "0", "0"]}, "bump": {"t0": )" +
                stage + "}}"),
            R"({"id":1,"outputs":{"r0":["3f400000","3f000000","00000000","00000000"]}})");
  const std::string texbeml =
      R"({"id": 2, "program": "ps_1_1\ntex t0\ntexbeml t1, t0\nmov r0, t1\n", "textures": )"
      R"({"t0": ["0", "0", "3e800000", "0"], "t1": ["3f000000", "3e800000", "3f800000", "3f800000"]}, "bump": )";
  EXPECT_EQ(run(texbeml + R"({"t1": )" + stage + "}}"),
            R"({"id":2,"outputs":{"r0":["3ec00000","3e400000","3f400000","3f400000"]}})");
  EXPECT_EQ(run(texbeml + R"({"t1": ["0", "0", "0", "0"]}})"),
            R"({"id":2,"error":"0: t1 is no array of six, expected six words in hex"})");
  EXPECT_EQ(run(texbeml + R"({"t6": []}})"), R"({"id":2,"error":"0: bump has \"t6\", expected t0 to t5"})");
}

TEST(ShaderBatch, AProgramThatDoesNotLoadIsAnErrorWithItsLine) {
  EXPECT_EQ(run(R"({"id": "b", "program": "vs_1_1\nmov oPos, q0\n"})"),
            R"({"id":"b","error":"2: column 11: 'q0' is not a register of vs_1_1"})");
  EXPECT_EQ(run(R"({"id": "b", "tokens": []})"),
            R"x({"id":"b","error":"1: column 1: the tokens end, expected a version (token 0)"})x");
}

TEST(ShaderBatch, ACaseThatIsWrongIsAnErrorOfLine0) {
  EXPECT_EQ(run(R"({"id": "a"})"), R"x({"id":"a","error":"0: expected \"program\" or \"tokens\""})x");
  EXPECT_EQ(run(R"({"id": 2, "program": "vs_1_1\nmov oPos, v0", "tokens": []})"),
            R"x({"id":2,"error":"0: expected \"program\" or \"tokens\""})x");
  EXPECT_TRUE(
      run(R"({"id": "a", "prgram": ""})").starts_with(R"({"id":"a","error":"0: unknown key \"prgram\",)"));
  const std::string program = R"({"id": "a", "program": "vs_1_1\nmov oPos, v0", )";
  EXPECT_EQ(run(program + R"("inputs": {"v16": []}})"),
            R"({"id":"a","error":"0: inputs has \"v16\", expected v0 to v15"})");
  for (const std::string name : {"v00", "v-0", "v1x", "v 1", "c1", "v", "1", ""})
    EXPECT_EQ(
        run(program + R"("inputs": {"v0": ["0", "0", "0", "0"], ")" + name + R"(": ["0", "0", "0", "0"]}})"),
        R"({"id":"a","error":"0: inputs has \")" + name + R"(\", expected v0 to v15"})");
  EXPECT_EQ(run(program + R"("inputs": {"v0": ["x", "0", "0", "0"]}})"),
            R"({"id":"a","error":"0: v0 is \"x\", expected 32 bits in hex"})");
  EXPECT_EQ(run(program + R"("inputs": {"v0": [[[1]], "0", "0", "0"]}})"),
            R"({"id":"a","error":"0: v0 is no text, expected 32 bits in hex"})");
  EXPECT_EQ(run(program + R"("constants": {"c0": {"a": [1]}}})"),
            R"({"id":"a","error":"0: c0 is no array of four, expected four words in hex"})");
  EXPECT_EQ(run(R"({"id": "t", "tokens": ["fffe0101", "123456789"]})"),
            R"({"id":"t","error":"0: a token is \"123456789\", expected 32 bits in hex"})");
  EXPECT_EQ(run(R"({"id": [1], "program": "vs_1_1\nmov oPos, v0"})"),
            R"({"id":null,"error":"0: \"id\" is neither text nor a number"})");
  for (const std::string key : {"texcoords", "textures", "bump"})
    EXPECT_EQ(run(program + '"' + key + "\": {}}"),
              R"({"id":"a","error":"0: unknown key \")" + key +
                  R"(\" for a vertex program, expected it with a pixel program alone"})");
  EXPECT_EQ(run(program + R"("id": "b"})"),
            R"({"id":null,"error":"0: the key \"id\" stands twice in an object, expected it once"})");
  EXPECT_EQ(run(program + R"("inputs": {"v1": ["0", "0", "0", "0"], "v1": ["0", "0", "0", "0"]}})"),
            R"({"id":null,"error":"0: the key \"v1\" stands twice in an object, expected it once"})");
}

// Unlike a line that is no object, an object that is no case does not count against the file.
TEST(ShaderBatch, ACaseWithAKeyTwiceIsACaseWithAnError) {
  std::istringstream cases(R"({"id": 1, "id": 2, "program": "vs_1_1\nmov oPos, v0\n"})");
  std::ostringstream results;
  EXPECT_EQ(error_of([&] { run_shader_batch(cases, "cases.jsonl", Arithmetic::ieee, results); }), "no error");
  EXPECT_NE(results.str().find("stands twice"), std::string::npos) << results.str();
}

TEST(ShaderBatch, MessagesQuoteLittle) {
  EXPECT_LT(run(R"({"id": 1, ")" + std::string(100000, 'k') + R"(": 0})").size(), 200u);
  EXPECT_LT(run(R"({"id": 1, "tokens": [")" + std::string(100000, '1') + R"("]})").size(), 200u);
  // The limit falls within the last character.
  std::string e_acute;
  for (int i = 0; i < 32; ++i) e_acute += "\xc3\xa9";
  EXPECT_TRUE(json::accept(run(R"({"id": 1, "x)" + e_acute + R"(": 0})")));
}

TEST(ShaderBatch, DeeplyNestedJsonIsAnError) {
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  const std::string error = R"({"id":null,"error":"0: this is nested deeper than 8, expected a case"})";
  EXPECT_EQ(run(R"({"id": )" + deep + R"(, "program": "vs_1_1\nmov oPos, v0\n"})"), error);
  EXPECT_EQ(run(R"({"id": 1, "program": "vs_1_1\nmov oPos, c0\n", "constants": {"c0": )" + deep + "}}"),
            error);
  EXPECT_EQ(run(deep), error);
}

TEST(ShaderBatch, ALineThatIsNoObjectIsAnsweredAndTheBatchGoesOn) {
  const std::string good = R"({"id": 1, "program": "vs_1_1\nmov oPos, v0\n"})";
  const std::string one = R"({"id":1,"outputs":{"oPos":["00000000","00000000","00000000","3f800000"]}})"
                          "\n";
  const std::string none = R"({"id":null,"error":"0: this is no JSON object, expected a case"})"
                           "\n";
  const std::string too_long = R"({"id":null,"error":"0: a line is longer than 16777216 bytes"})"
                               "\n";
  const std::string padding((std::size_t{16} << 20) + 1, ' ');
  std::istringstream cases(good + "\n\n[1]\n" + good + "\n{\"id\":\n" + "{" + padding + "}\n" + good);
  std::ostringstream results;
  EXPECT_EQ(error_of([&] { run_shader_batch(cases, "cases.jsonl", Arithmetic::ieee, results); }),
            "cases.jsonl:3: this is no case, expected a JSON object (lines like it: 3)");
  EXPECT_EQ(results.str(), one + none + one + none + too_long + one);
}

TEST(ShaderBatch, AWrongCaseDoesNotEndABatch) {
  std::istringstream cases("{\"id\": 1}\n{\"id\": \"b\", \"program\": \"vs_1_1\\n\"}\n");
  std::ostringstream results;
  EXPECT_NO_THROW(run_shader_batch(cases, "cases.jsonl", Arithmetic::ieee, results));
  EXPECT_EQ(results.str(), R"x({"id":1,"error":"0: expected \"program\" or \"tokens\""})x"
                           "\n"
                           R"x({"id":"b","error":"1: column 1: a program has at least one instruction"})x"
                           "\n");
}

// The registers of the pixel unit hold no NaN.
TEST(ShaderBatch, NanCountsAsZeroInAPixelProgram) {
  const std::string nan = R"(["7fc00000", "ffc00001", "7f800001", "7fffffff"])";
  const std::string zero = R"("outputs":{"r0":["00000000","00000000","00000000","00000000"]})";
  for (const std::string program :
       {R"(ps_1_1\nmov r0, v0\n)", R"(ps_1_1\nmov r0, v1\n)", R"(ps_1_1\nmov_sat r0, v0\n)",
        R"(ps_1_1\nmov r0, c0\n)", R"(ps_1_1\ntex t0\nmov r0, t0\n)", R"(ps_1_1\ntex t0\nmov_sat r0, t0\n)",
        R"(ps_1_1\ntexcoord t0\nmov r0.rgb, t0\n+ mov r0.a, v0\n)",
        R"(ps_1_4\ntexcrd r0.rgb, t0\nmov r0.a, r0.b\n)", R"(ps_1_4\ntexld r0, t0\nmov r1, r0\n)",
        R"(ps_1_4\ntexld r0, t0\n)"}) {
    const std::string result =
        run(R"({"id": 1, "program": ")" + program + R"(", "inputs": {"v0": )" + nan + R"(, "v1": )" + nan +
            R"(}, "constants": {"c0": )" + nan + R"(}, "texcoords": {"t0": )" + nan +
            R"(}, "textures": {"t0": )" + nan + "}}");
    EXPECT_NE(result.find(zero), std::string::npos) << program << ' ' << result;
  }
}

TEST(ShaderBatch, TheVectorsOfTheNv20) {
  const json vectors = oracle("vertex_programs.json");
  std::stringstream cases, results;
  for (const json& test : vectors["cases"])
    cases << json{{"id", test["id"]},
                  {"tokens", test["tokens"]},
                  {"constants", test["constants"]},
                  {"inputs", test["inputs"]}}
          << '\n';
  run_shader_batch(cases, "cases", Arithmetic::nv20, results);
  for (const json& test : vectors["cases"]) {
    std::string line;
    ASSERT_TRUE(std::getline(results, line));
    EXPECT_EQ(json::parse(line)["outputs"][test["output"].get<std::string>()], test["nv20"]) << test["id"];
  }
}

}  // namespace
}  // namespace splatscope::studies
