#include "studies/shader_debugger.h"

#include <gtest/gtest.h>

#include <sstream>

#include "model/testing/error_of.h"

namespace splatscope::studies {
namespace {

std::string transcript(const std::string& program, const std::string& commands,
                       const std::string& registers = "{}") {
  ShaderDebugger debugger(isa::load(program, "a"), ShaderCase(registers, "case", 1), Arithmetic::ieee);
  std::istringstream in(commands);
  std::ostringstream out;
  debugger.run(in, "commands", out, false);
  return out.str();
}

const std::string kProgram = "vs_1_1\nmov r0, v0\nadd r0.x, r0, r0\nmov oPos, r0\n";
const std::string kInputs = R"({"inputs": {"v0": ["3f800000", "40000000", "0", "0"]}})";

TEST(ShaderDebugger, StepsShowWhatIsReadAndWritten) {
  EXPECT_EQ(transcript(kProgram, "step\n", kInputs),
            "   2  mov r0, v0\n"
            "        reads v0 = (1, 2, 0, 0)  3f800000 40000000 00000000 00000000\n"
            "        r0 before = (0, 0, 0, 0)  00000000 00000000 00000000 00000000\n"
            "        r0 after  = (1, 2, 0, 0)  3f800000 40000000 00000000 00000000\n");
}

TEST(ShaderDebugger, RunsToALineAndBack) {
  const std::string print = "r0 = (2, 2, 0, 0)  40000000 40000000 00000000 00000000\n";
  const std::string to_4 = transcript(kProgram, "run 4\nprint r0\n", kInputs);
  EXPECT_EQ(to_4.substr(to_4.size() - print.size()), print);
  const std::string back = transcript(kProgram, "run 4\nback\nprint r0\n", kInputs);
  EXPECT_NE(back.find("r0 = (1, 2, 0, 0)  3f800000", back.find("after  = (2")), std::string::npos) << back;
}

TEST(ShaderDebugger, ContinuesUntilAWatchedRegisterChanges) {
  const auto stops_before = [](const std::string& instruction, const std::string& program,
                               const std::string& commands) {
    const std::string text = transcript(program, commands + "list\n", kInputs);
    EXPECT_EQ(text.find("end of the program"), std::string::npos) << text;
    EXPECT_NE(text.find("\n>   " + instruction + "\n"), std::string::npos) << text;
  };
  const std::string vertex = "vs_1_1\nmov r1, v0\nmov r0, v0\nmov oPos, r0\nmov oT0, r0\n";
  stops_before("4  mov oPos, r0", vertex, "watch r0\ncontinue\n");
  stops_before("5  mov oT0, r0", vertex, "watch oPos\nstep\ncontinue\n");
  stops_before("5  mov oT0, r0", vertex, "watch r0\nwatch oPos\ncontinue\ncontinue\n");
  stops_before("4  mov r1, v0", "ps_1_1\nmul r0.rgb, v0, v0\n+ mov r0.a, v0\nmov r1, v0\n",
               "watch r0\ncontinue\n");
  const std::string never = transcript("vs_1_1\nmov r0, c0\nmov oPos, v0\n", "watch r0\ncontinue\n", kInputs);
  EXPECT_NE(never.find("end of the program"), std::string::npos) << never;
}

TEST(ShaderDebugger, PairsAreOneStepAndRelativeConstantsAreFollowed) {
  const std::string pair =
      transcript("ps_1_1\nmov r0, v0\nmov r0.rgb, r0.a\n+ mov r0.a, r0.b\n", "step 2\nlist\n");
  EXPECT_NE(pair.find("end of the program"), std::string::npos);
  const std::string there_and_back =
      transcript("ps_1_1\nmov r0, v0\nmov r0.rgb, r0.a\n+ mov r0.a, r0.b\n", "step 2\nback 2\nlist\n");
  EXPECT_NE(there_and_back.find("\n>   2  mov r0, v0\n"), std::string::npos) << there_and_back;
  const std::string relative =
      transcript("vs_1_1\nmov a0.x, c0.x\nmov oPos, c[a0.x + 1]\n", "step 2\n",
                 R"({"constants": {"c0": ["40000000", "0", "0", "0"], "c3": ["3f800000", "0", "0", "0"]}})");
  EXPECT_NE(relative.find("reads c3 = (1, 0, 0, 0)"), std::string::npos) << relative;
}

TEST(ShaderDebugger, ShowsAllRowsOfAMatrix) {
  const std::string text =
      transcript("vs_1_1\nm3x3 r0.xyz, v0, c4\nmov r0.w, v0.w\nmov oPos, r0\n", "step\n", kInputs);
  for (const char* row : {"reads c4 = ", "reads c5 = ", "reads c6 = "})
    EXPECT_NE(text.find(row), std::string::npos) << text;
  EXPECT_EQ(text.find("reads c7"), std::string::npos) << text;
}

TEST(ShaderDebugger, ShowsPixelRegistersInTheirRanges) {
  const std::string text = transcript("ps_1_4\ndef c2, 4, -3, 0.5, 0\nmad r0, v0, c2, c2\n", "step\n",
                                      R"({"inputs": {"v0": ["40400000", "c0400000", "3f000000", "0"]}})");
  EXPECT_NE(text.find("reads v0 = (1, 0, 0.5, 0)"), std::string::npos) << text;
  EXPECT_NE(text.find("reads c2 = (1, -1, 0.5, 0)"), std::string::npos) << text;
  EXPECT_EQ(text.find("reads c2", text.find("reads c2") + 1), std::string::npos) << "once\n" << text;
}

TEST(ShaderDebugger, ShowsWhatKillsAndWhatIsSampledFrom) {
  const std::string registers =
      R"({"texcoords": {"t0": ["0", "3f800000", "0", "0"], "t1": ["bf800000", "0", "0", "0"]}})";
  EXPECT_NE(transcript("ps_1_4\ntexld r0, t0\n", "step\n", registers).find("reads t0 = (0, 1, 0, 0)"),
            std::string::npos);
  const std::string kept = transcript("ps_1_1\ntexkill t0\nmov r0, v0\n", "step\n", registers),
                    cancelled = transcript("ps_1_1\ntexkill t1\nmov r0, v0\n", "step\n", registers);
  EXPECT_NE(kept.find("keeps the fragment"), std::string::npos) << kept;
  EXPECT_NE(cancelled.find("cancels the fragment"), std::string::npos) << cancelled;
}

TEST(ShaderDebugger, ShowsTheDepthThatAProgramWrites) {
  const std::string text = transcript("ps_1_4\ntexcrd r5.rgb, t1\nphase\ntexdepth r5\nmov r0, v0\n",
                                      "watch depth\ncontinue\nprint depth\n",
                                      R"({"texcoords": {"t1": ["3e800000", "3f000000", "0", "0"]}})");
  const std::string step = text.substr(text.find("texdepth"));  // 0.25 / 0.5
  EXPECT_NE(step.find("reads r5 = (0.25, 0.5, 0, 0)"), std::string::npos) << text;
  EXPECT_NE(step.find("        depth = (0.5, "), std::string::npos) << text;
  EXPECT_NE(text.find("\ndepth = (0.5, "), std::string::npos) << text;
  EXPECT_EQ(text.find("mov r0"), std::string::npos) << "it stops where the depth changes\n" << text;
}

TEST(ShaderDebugger, SaysWhetherAFragmentIsKilled) {
  const auto killed_by = [](const std::string& t0) {
    return transcript("ps_1_1\ntexkill t0\nmov r0, v0\n", "step\n", R"({"texcoords": {"t0": [)" + t0 + "]}}");
  };
  for (const char* t0 :
       {R"("bf800000", "0", "0", "0")", R"("0", "bf800000", "0", "0")", R"("0", "0", "bf800000", "0")"})
    EXPECT_NE(killed_by(t0).find("cancels the fragment"), std::string::npos) << killed_by(t0);
  EXPECT_NE(killed_by(R"("0", "0", "0", "bf800000")").find("keeps the fragment"), std::string::npos)
      << "w is not read";
}

TEST(ShaderDebugger, ShowsTheRowsAndTheMatricesThatAreNoRegisters) {
  const std::string registers = R"({"texcoords": {"t1": ["3e800000", "0", "0", "0"]}, "bump": )"
                                R"({"t1": ["3f000000", "0", "0", "bf800000", "40000000", "3e800000"]}})";
  const std::string pad =
      transcript("ps_1_1\ntex t0\ntexm3x2pad t1, t0\ntexm3x2tex t2, t0\nmov r0, t2\n", "step 2\n", registers);
  EXPECT_NE(pad.find("reads t1 = (0.25, 0, 0, 0)"), std::string::npos) << pad;
  EXPECT_EQ(pad.find("t1 before"), std::string::npos) << "a row, no result\n" << pad;
  const auto bumped = [&](const std::string& texbem) {
    return transcript("ps_1_1\ntex t0\n" + texbem + " t1, t0\nmov r0, t1\n", "step 2\n", registers);
  };
  for (const char* texbem : {"texbem", "texbeml"})
    EXPECT_NE(bumped(texbem).find("reads bump matrix of stage 1 = (0.5, 0, 0, -1)"), std::string::npos)
        << bumped(texbem);
  const std::string luminance = "reads luminance scale 2 and offset 0.25 of stage 1";
  EXPECT_EQ(bumped("texbem").find(luminance), std::string::npos);
  EXPECT_NE(bumped("texbeml").find(luminance), std::string::npos) << bumped("texbeml");
}

// Before c0, where nothing is: zeros.
TEST(ShaderDebugger, AConstantOutOfRangeIsCalledThat) {
  const std::string text = transcript("vs_1_1\nmov a0.x, c0.x\nmov oPos, c[a0.x + 1]\n", "step 2\n",
                                      R"({"constants": {"c0": ["c0a00000", "0", "0", "0"]}})");
  EXPECT_NE(text.find("reads c[out of range] = (0, 0, 0, 0)"), std::string::npos) << text;
}

TEST(ShaderDebugger, AnUnwatchedRegisterStopsNothing) {
  const std::string text = transcript(kProgram, "watch r0\nunwatch r0\ncontinue\n", kInputs);
  EXPECT_NE(text.find("end of the program"), std::string::npos) << text;
}

TEST(ShaderDebugger, RestartsHelpsAndQuits) {
  const std::string text = transcript(kProgram, "step 2\nrestart\nlist\nhelp\nquit\nstep\n", kInputs);
  EXPECT_NE(text.find("\n>   2  mov r0, v0\n"), std::string::npos) << text;
  EXPECT_NE(text.find("restart, help, quit\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("reads", text.find("restart, help")), std::string::npos) << "after quit\n" << text;
}

TEST(ShaderDebugger, AWrongCommandIsAUserErrorWithItsLine) {
  const auto error_of = [](const std::string& commands) {
    return splatscope::error_of([&] { transcript(kProgram, commands); });
  };
  EXPECT_EQ(error_of("step\nprint r7\n"), "commands:2: the program writes no r7, expected oPos, r0");
  EXPECT_EQ(error_of("jump\n").substr(0, 32), "commands:1: 'jump' is no command");
  EXPECT_EQ(error_of("run\n"), "commands:1: run where? expected a line");
  EXPECT_EQ(error_of("watch\n"), "commands:1: watch what? expected registers");
  EXPECT_EQ(error_of("watch r7\n"), "commands:1: the program writes no r7, expected oPos, r0");
  EXPECT_EQ(error_of("step x\n"), "commands:1: 'x', expected a whole number from 1 to 2147483647");
}

}  // namespace
}  // namespace splatscope::studies
