#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <string_view>

#include "model/isa/program.h"
#include "model/testing/error_of.h"

namespace splatscope::isa {
namespace {

std::string error_of(const std::string& text) {
  return splatscope::error_of([&] { load(text, "a.vs"); });
}

TEST(Assembler, ReadsOperandsMasksAndNegation) {
  const Program program =
      assemble("vs.1.1 // version\n; comment\nMAD r1.xz, -v0.wzy, c[3 + a0.x].g, R0 /* two\nlines */\n", "a");
  ASSERT_EQ(program.instructions.size(), 1u);
  const Instruction& mad = program.instructions[0];
  EXPECT_EQ(mad.opcode, Opcode::mad);
  EXPECT_EQ(mad.line, 3);
  EXPECT_EQ(mad.destination, (Destination{RegisterFile::temporary, 1, 0x5}));
  EXPECT_EQ(mad.sources[0], (Source{RegisterFile::input, 0, {3, 2, 1, 1}, true}));
  EXPECT_EQ(mad.sources[1], (Source{RegisterFile::constant, 3, {1, 1, 1, 1}, false, true}));
  EXPECT_EQ(mad.sources[2], (Source{RegisterFile::temporary, 0}));
}

TEST(Assembler, ANumberTooSmallIsZero) {
  const Program program = assemble("vs_1_1\ndef c0, 1e-50, -1e-50, 1e-400, 1.4e-45\nmov oPos, c0\n", "a");
  const auto& [a, b, c, least] = program.definitions[0].values;
  EXPECT_EQ(std::bit_cast<std::uint32_t>(a), 0u);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(b), 0x80000000u);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(c), 0u);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(least), 1u);
}

// Numbers before and in the brackets add up, as D3DX reads them.
TEST(Assembler, AddsAllNumbersOfAnIndex) {
  const std::pair<const char*, int> sums[] = {{"c[a0.x]", 0},        {"c0[a0.x]", 0},
                                              {"c1[a0.x + 2]", 3},   {"c4[ 2 ]", 6},
                                              {"c[2+10+12]", 24},    {"c[ 2 + a0.x + 12 ]", 14},
                                              {"c3[1 + a0.x+ 4]", 8}};
  for (const auto& [text, sum] : sums) {
    const Program program = assemble(std::string("vs_1_1\nmov r0, ") + text, "a");
    const bool relative = std::string_view(text).find("a0") != std::string_view::npos;
    const Source expected{
        RegisterFile::constant, static_cast<std::uint16_t>(sum), {0, 1, 2, 3}, false, relative};
    EXPECT_EQ(program.instructions[0].sources[0], expected) << text;
  }
  EXPECT_EQ(error_of("vs_1_1\nmov r0, c2000[a0.x + 48]\n"),
            "a.vs:2:22: c2048 does not exist, expected c2047 at most");
  EXPECT_EQ(error_of("vs_1_1\nmov r0, v0[a0.x]\n"), "a.vs:2:9: 'v0' cannot be indexed, only c[...]");
}

TEST(Assembler, ReadsPixelModifiersAndCoissue) {
  const Program program =
      assemble("ps_1_4\nmul_x2_sat r0.rgb, 1 - r1, r2_bx2.a\n+ mov_d8 r3.a, -v0_bias\n", "a");
  ASSERT_EQ(program.instructions.size(), 2u);
  const Instruction& mul = program.instructions[0];
  EXPECT_EQ(mul.destination, (Destination{RegisterFile::temporary, 0, 0x7, 1, true}));
  EXPECT_EQ(mul.sources[0].modifier, SourceModifier::invert);
  EXPECT_EQ(mul.sources[1].modifier, SourceModifier::bx2);
  EXPECT_EQ(mul.sources[1].swizzle, (std::array<std::uint8_t, 4>{3, 3, 3, 3}));
  EXPECT_FALSE(mul.coissue);
  EXPECT_TRUE(program.instructions[1].coissue);
  EXPECT_EQ(program.instructions[1].destination.shift, -3);
  EXPECT_TRUE(program.instructions[1].sources[0].negate);
}

TEST(Assembler, ReadsDefinitionsAndDeclarations) {
  const Program program = assemble("vs_1_1\ndef c3, 1, -.5, 2e3f, +0\ndcl_texcoord2 v7\nmov oPos, v7\n", "a");
  ASSERT_EQ(program.definitions.size(), 1u);
  EXPECT_EQ(program.definitions[0].index, 3);
  EXPECT_EQ(program.definitions[0].values, (std::array<float, 4>{1, -0.5f, 2000, 0}));
  ASSERT_EQ(program.declarations.size(), 1u);
  EXPECT_EQ(program.declarations[0].usage, 5);
  EXPECT_EQ(program.declarations[0].usage_index, 2);
}

TEST(Assembler, CountsSlotsWithMacrosAtTheirExpansion) {
  EXPECT_EQ(
      slot_count(load("vs_1_1\ndef c4, 0, 0, 0, 0\nm4x4 oPos, v0, c0\nexp r0, v0.x\nfrc r0.xy, v0\n", "a")),
      17);
  // A pair counts as its longer half.
  EXPECT_EQ(slot_count(assemble("ps_1_2\nmov r0.rgb, v0\n+ cmp r0.a, r1, v0, v1\n", "a")), 2);
  EXPECT_EQ(slot_count(assemble("ps_1_2\ncmp r0.rgb, r1, v0, v1\n+ mov r0.a, v0\n", "a")), 2);
}

TEST(Assembler, ErrorsNameFileLineColumnAndRule) {
  EXPECT_EQ(error_of("vs_1_1\nmov oPos, v0\n  foo r0, v0\n"),
            "a.vs:3:3: unknown instruction 'foo' in vs_1_1");
  EXPECT_EQ(error_of("vs_1_1\n # if 0\nmov oPos, v0\n#endif\n"),
            "a.vs:2:2: '#if' needs a preprocessor, expected its output");
  EXPECT_EQ(error_of("vs_1_1\n#line 3\nmov oPos, v0 # iffy\n"), "no error");
  EXPECT_EQ(error_of("mov oPos, v0\n"),
            "a.vs:1:1: 'mov' is not a version, expected vs_1_1 or ps_1_1 to ps_1_4 first");
  EXPECT_EQ(error_of("vs_1_1\nmov oPos v0\n"),
            "a.vs:2:10: 'v0' stands here, expected ',' and another operand");
  EXPECT_EQ(error_of("vs_1_1\nmov oPos, v0 v1\n"),
            "a.vs:2:14: 'v1' stands here, expected the end of the line");
  EXPECT_EQ(error_of("vs_1_1\nmov oPos.yx, v0\n"),
            "a.vs:2:10: '.yx' is not a write mask, expected letters of xyzw or rgba in that order");
  EXPECT_EQ(error_of("vs_1_1\nmov oPos, v0 /* \n"), "a.vs:2:14: this comment does not end, expected */");
  EXPECT_EQ(error_of("vs_1_1\nmov oPos, v0\nadd r0, c0, c1\n"),
            "a.vs:3:1: 2 different c# registers in one instruction, vs_1_1 has 1 read port");
  EXPECT_EQ(error_of(""), "a.vs:1:1: the line ends here, expected vs_1_1 or ps_1_1 to ps_1_4 first");
  EXPECT_EQ(error_of("[surfels]\n"), "a.vs:1:1: '[' stands here, expected vs_1_1 or ps_1_1 to ps_1_4 first");
  EXPECT_EQ(error_of("vs_1_1\nmov oPos,\n"), "a.vs:2:10: the line ends here, expected a register of vs_1_1");
  EXPECT_EQ(
      error_of("vs_1_1\nmov oPos, v0_x3\n"),
      "a.vs:2:11: '_x3' is not a source modifier here, expected one of _bias _bx2 _x2 _dz _dw in a pixel "
      "program");
  EXPECT_EQ(error_of("ps_1_1\nmov r0, 1-v0_bx2\n"),
            "a.vs:2:9: '_bx2' beside another modifier of the source, expected one alone");
  EXPECT_EQ(error_of("ps_1_1\nmov r0, 1-\n"), "a.vs:2:11: the line ends here, expected a register of ps_1_1");
  EXPECT_EQ(error_of("vs_1_1\ndef c0, 1, -1e99, 0, 0\n"),
            "a.vs:2:13: '1e99' stands here, expected a number of 32 bits");
  EXPECT_EQ(error_of("vs_1_1\ndef c0, 3.4028236e+38, 0, 0, 0\n"),
            "a.vs:2:9: '3.4028236e+38' stands here, expected a number of 32 bits");
  EXPECT_EQ(error_of(std::string("vs_1_1\nmov oPos, v0 \0 x\n", 24)),
            "a.vs:2:14: the byte 0x00 stands here, expected the end of the line");
  EXPECT_EQ(error_of("vs_1_1\nmov oPos, v0 \u00e9\n"),
            "a.vs:2:14: the byte 0xc3 stands here, expected the end of the line");
}

TEST(Assembler, UsagesHaveAnIndexFrom0To15) {
  const auto declared = [](std::string_view usage) {
    return error_of(fmt::format("vs_1_1\ndcl_{} v1\nmov oPos, v1\n", usage));
  };
  for (const char* usage : {"texcoord", "texcoord0", "texcoord07", "texcoord15"})
    EXPECT_EQ(declared(usage), "no error") << usage;
  for (const char* usage : {"texcoord16", "texcoord007", "texcoord0z", "texcoord1_", "tex2"})
    EXPECT_EQ(declared(usage), fmt::format("a.vs:2:1: 'dcl_{}' is not a declaration, expected dcl_position, "
                                           "dcl_normal0, ...",
                                           usage));
}

}  // namespace
}  // namespace splatscope::isa
