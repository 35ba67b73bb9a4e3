#include "model/isa/analysis.h"

#include <gtest/gtest.h>

namespace splatscope::isa {
namespace {

std::vector<bool> dead(const Analysis& analysis) {
  std::vector<bool> result;
  for (const InstructionAnalysis& instruction : analysis.instructions) result.push_back(instruction.dead);
  return result;
}

TEST(Analysis, FindsWhatNoOutputDependsOn) {
  const Analysis analysis =
      analyze(load("vs_1_1\n"
                   "mov r0, v0\n"        // read by the third
                   "mov r1, v1\n"        // overwritten unread but for .w, which is never read
                   "mov r1.xyz, r0\n"    // read
                   "mul r2, r0, r1.x\n"  // read by a dead one only
                   "add r3, r2, r2\n"    // never read
                   "mov oPos, v1\n"      // overwritten
                   "mov oPos, r1.xyzz\n",
                   "a"));
  EXPECT_EQ(dead(analysis), (std::vector<bool>{false, true, false, true, true, true, false}));
}

TEST(Analysis, RegistersLiveAfterEachInstruction) {
  const Analysis analysis =
      analyze(load("vs_1_1\nmov r0, v0\ndp3 r1.w, r0, r0\nmov a0.x, r1.w\nmul oPos, r0, c[a0.x]\n", "a"));
  EXPECT_EQ(to_string(analysis.instructions[0].live_after), "r0");
  EXPECT_EQ(to_string(analysis.instructions[1].live_after), "r0 r1.w");
  EXPECT_EQ(to_string(analysis.instructions[2].live_after), "r0 a0.x");
  EXPECT_EQ(to_string(analysis.instructions[3].live_after), "");
  EXPECT_EQ(analysis.most_live_temporaries, 2);
}

TEST(Analysis, CriticalPathIsTheLongestChainInSlots) {
  const Analysis analysis =
      analyze(load("vs_1_1\n"
                   "m4x4 r0, v0, c0\n"  // 4 slots
                   "mov r1, v0\n"
                   "add r1, r1, c4\n"
                   "rcp r2.w, r0.w\n"
                   "mov oPos, r1\n"
                   "mul oT0, r0, r2.w\n",
                   "a"));
  EXPECT_EQ(analysis.critical_path, (std::vector<std::size_t>{0, 3, 5}));
  EXPECT_EQ(analysis.critical_slots, 6);
}

TEST(Analysis, FollowsInputs) {
  const isa::Program program = load(
      "vs_1_1\n"
      "mov r0, v0\n"
      "add r1, r0, v3\n"
      "mul r1.x, r0, r0\n"  // r1.x no longer
      "mov oD0, r1.x\n"
      "mov oPos, r1\n",
      "a");
  EXPECT_EQ(dependent_on(program, 1u << 3), (std::vector<bool>{false, true, false, false, true}));
  EXPECT_EQ(dependent_on(program, 1u << 5), std::vector<bool>(5));
}

TEST(Analysis, TheLastRowOfATextureMatrixReadsTheOthers) {
  const std::string matrix = "ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3tex t3, t0\n";
  const Analysis used = analyze(load(matrix + "mov r0, t3\n", "a"));
  EXPECT_EQ(dead(used), std::vector<bool>(5));
  EXPECT_EQ(used.critical_path, (std::vector<std::size_t>{0, 1, 3, 4}));
  EXPECT_EQ(used.critical_slots, 4);
  const Analysis unused = analyze(load(matrix + "mov r0, v0\n", "a"));
  EXPECT_EQ(dead(unused), (std::vector<bool>{true, true, true, true, false}));
}

TEST(Analysis, TexdepthReadsTwoComponents) {
  const Analysis analysis =
      analyze(load("ps_1_4\ntexcrd r5.rg, t0_dw.xyw\nmov r5.b, c0\nphase\ntexdepth r5\nmov r0, v0\n", "a"));
  EXPECT_EQ(dead(analysis), (std::vector<bool>{false, true, false, false, false}));
}

TEST(Analysis, PairsReadBeforeTheyWriteAndPhasesLoseAlpha) {
  const Analysis pair = analyze(load("ps_1_1\nmov r0, v0\nmov r0.rgb, r0.a\n+ mov r0.a, v1\n", "a"));
  EXPECT_EQ(dead(pair), (std::vector<bool>{false, false, false}))
      << "the pair's first half reads the alpha before it";
  const Analysis phases = analyze(
      load("ps_1_4\ntexld r0, t0\ntexcrd r1.rgb, t1\nmov r1.a, r0.a\nphase\ntexkill r1\nmov r0, c0\n", "a"));
  EXPECT_EQ(dead(phases), (std::vector<bool>{true, false, true, false, false, false}));
}

}  // namespace
}  // namespace splatscope::isa
