#include <gtest/gtest.h>

#include "program.h"

// `splatscope shader` as a user meets it.
namespace splatscope::tests {
namespace {

const std::string kProgram = "vs_1_1\nm4x4 oPos, v0, c0\nmov r0, v1\nmov oD0, v1\n";

TEST(ShaderCommand, CountsSlots) {
  const ScratchFolder folder;
  folder.file("a.vs", kProgram);
  const Outcome outcome = run_program({"shader", "count", "a.vs"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(outcome.out, "6\n");
}

TEST(ShaderCommand, AByteOrderMarkBeforeTheTextIsNoPartOfIt) {
  const ScratchFolder folder;
  folder.file("a.vs", "\xEF\xBB\xBF" + kProgram);
  const Outcome counted = run_program({"shader", "count", "a.vs"}, folder.path());
  EXPECT_EQ(counted.status, 0) << counted.error;
  EXPECT_EQ(counted.out, "6\n");
  folder.file("m.toml", "\xEF\xBB\xBF" + std::string("base = \"radeon-8500\"\n"));
  const Outcome shown = run_program({"machine", "show", "m.toml"}, folder.path());
  EXPECT_EQ(shown.status, 0) << shown.error;
}

TEST(ShaderCommand, AssemblesToTokensAndBack) {
  const ScratchFolder folder;
  folder.file("a.vs", kProgram);
  ASSERT_EQ(run_program({"shader", "assemble", "a.vs", "-o", "a.vso"}, folder.path()).status, 0);
  EXPECT_EQ(text_of(folder.path() / "a.vso").substr(0, 8),
            std::string("\x01\x01\xfe\xff\x14\x00\x00\x00", 8));
  EXPECT_EQ(run_program({"shader", "disassemble", "a.vso"}, folder.path()).out, kProgram);
  EXPECT_EQ(run_program({"shader", "count", "a.vso"}, folder.path()).out, "6\n");
}

TEST(ShaderCommand, CheckSaysWhatIsDeadAndWhatItCosts) {
  const ScratchFolder folder;
  folder.file("a.vs", kProgram);
  const Outcome outcome = run_program({"shader", "check", "a.vs"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_NE(outcome.out.find("a.vs: vs_1_1, 6 slots, at most 0 temporaries live, 1 dead instructions\n"),
            std::string::npos);
  EXPECT_NE(outcome.out.find("critical path: 4 slots, by line: 2\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("geforce4-ti4400: "), std::string::npos);
  EXPECT_NE(outcome.out.find("radeon-8500: "), std::string::npos);
}

TEST(ShaderCommand, CheckCountsTheClocksOfAPixelProgram) {
  const ScratchFolder folder;
  const auto clocks = [&](const std::string& program, const char* expected) {
    folder.file("a.ps", program);
    const Outcome outcome = run_program({"shader", "check", "a.ps"}, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_NE(outcome.out.find(std::string("geforce4-ti4400: ") + expected), std::string::npos)
        << program << outcome.out;
  };
  clocks("ps_1_1\ntex t0\nmul r0, t0, v0\nadd r0, r0, v1\nmul r0.rgb, r0, v0\n", "3 clocks a quad");
  clocks("ps_1_1\ntex t0\nmul r0.rgb, t0, v0\n+ mul r0.a, t0, v0\n", "1 clocks a quad");
  clocks("ps_1_1\nmov r0, v0\n", "1 clocks a quad");
  clocks("ps_1_2\ndp4 r0, v0, v1\n", "2 clocks a quad");
}

TEST(ShaderCommand, ABrokenRuleIsExit2WithItsPlaceAndNoFile) {
  const ScratchFolder folder;
  folder.file("a.vs", "vs_1_1\nadd r0, c0, c1\nmov oPos, v0\n");
  const std::string rule = "a.vs:2:1: 2 different c# registers in one instruction, vs_1_1 has 1 read port\n";
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"shader", "check", "a.vs"},
                                                    {"shader", "count", "a.vs"},
                                                    {"shader", "assemble", "a.vs", "-o", "a.vso"}}) {
    const Outcome outcome = run_program(arguments, folder.path());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.error, rule);
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.vs"});
  EXPECT_EQ(run_program({"shader", "assemble", "a.vs", "--no-validate", "-o", "a.vso"}, folder.path()).status,
            0);
  EXPECT_EQ(run_program({"shader", "check", "a.vso"}, folder.path()).error, "a.vso" + rule.substr(4));
}

TEST(ShaderCommand, FilesThatAreNoShaderAreExit2) {
  const ScratchFolder folder;
  folder.file("cut.vso", std::string("\x01\x01\xfe\xff\x01\x00\x00", 7));
  EXPECT_EQ(run_program({"shader", "disassemble", "cut.vso"}, folder.path()).error,
            "cut.vso: 7 bytes are not whole tokens, expected a multiple of 4\n");
  EXPECT_EQ(run_program({"shader", "check", "none.vs"}, folder.path()).status, 2);
  EXPECT_EQ(run_program({"shader", "run", "--batch", "none.jsonl"}, folder.path()).status, 2);
  EXPECT_EQ(run_program({"shader", "run", "--batch", "."}, folder.path()).status, 2);
}

TEST(ShaderCommand, RunsABatchInEitherArithmetic) {
  const ScratchFolder folder;
  folder.file("cases.jsonl",
              "{\"id\": \"q\", \"program\": \"vs_1_1\\nrsq oPos, v0.x\\n\", \"inputs\": {\"v0\": "
              "[\"3f800000\", \"0\", "
              "\"0\", \"0\"]}}\n");
  EXPECT_EQ(run_program({"shader", "run", "--batch", "cases.jsonl"}, folder.path()).out,
            "{\"id\":\"q\",\"outputs\":{\"oPos\":[\"3f800000\",\"3f800000\",\"3f800000\",\"3f800000\"]}}\n");
  EXPECT_EQ(
      run_program({"shader", "run", "--batch", "cases.jsonl", "--arithmetic", "nv20"}, folder.path()).out,
      "{\"id\":\"q\",\"outputs\":{\"oPos\":[\"3f7fffff\",\"3f7fffff\",\"3f7fffff\",\"3f7fffff\"]}}\n");
  const Outcome wrong =
      run_program({"shader", "run", "--batch", "cases.jsonl", "--arithmetic", "bcd"}, folder.path());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.error.find("--arithmetic: \"bcd\", expected ieee or nv20 "), std::string::npos)
      << wrong.error;
}

TEST(ShaderCommand, ABatchGoesOnAfterALineThatIsNoCase) {
  const ScratchFolder folder;
  const std::string good = "{\"id\": 1, \"program\": \"vs_1_1\\nmov oPos, v0\\n\"}\n";
  const std::string answer =
      "{\"id\":1,\"outputs\":{\"oPos\":[\"00000000\",\"00000000\",\"00000000\",\"3f800000\"]}}\n";
  folder.file("cases.jsonl", "{\"id\": " + std::string(200000, '[') + "\n" + good);
  const Outcome outcome = run_program({"shader", "run", "--batch", "cases.jsonl"}, folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.error, "cases.jsonl:1: this is no case, expected a JSON object (lines like it: 1)\n");
  EXPECT_EQ(outcome.out,
            "{\"id\":null,\"error\":\"0: this is nested deeper than 8, expected a case\"}\n" + answer);

  folder.file("wrong.jsonl", "{\"id\": 7, \"tokens\": [1]}\n" + good);
  const Outcome wrong = run_program({"shader", "run", "--batch", "wrong.jsonl"}, folder.path());
  EXPECT_EQ(wrong.status, 0);
  EXPECT_EQ(wrong.out, "{\"id\":7,\"error\":\"0: a token is no text, expected 32 bits in hex\"}\n" + answer);
}

TEST(ShaderCommand, DebugTakesCommandsFromAPipe) {
  const ScratchFolder folder;
  folder.file("a.vs", kProgram);
  folder.file("case.json", "{\"inputs\": {\"v1\": [\"3f800000\", \"0\", \"0\", \"0\"]}}");
  const std::string command =
      fmt::format("cd '{}' && printf 'run 4\\nstep\\n' | '{}' shader debug a.vs --registers case.json > out",
                  folder.path().string(), SPLATSCOPE_PROGRAM);
  EXPECT_EQ(std::system(command.c_str()), 0);
  const std::string out = text_of(folder.path() / "out");
  EXPECT_NE(out.find("oD0 after  = (1, 0, 0, 0)  3f800000 00000000 00000000 00000000\nend of the program\n"),
            std::string::npos)
      << out;
}

}  // namespace
}  // namespace splatscope::tests
