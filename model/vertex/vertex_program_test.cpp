#include "model/vertex/vertex_program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <memory>
#include <random>
#include <string>

#include "model/isa/opcode.h"
#include "model/testing/random_seed.h"
#include "model/testing/simd_targets.h"

namespace splatscope::vertex {
namespace {

struct Batches {
  std::unique_ptr<InputBatch> in = std::make_unique<InputBatch>();
  std::unique_ptr<OutputBatch> out = std::make_unique<OutputBatch>();
};

// Vertex 0's `output` of a program whose v0 is (1, 2, 3, 4) and c0..c3 are (10,20,30,40), (11, ...), ...
Vec4 run(const std::string& text, Output output, Arithmetic arithmetic = Arithmetic::ieee) {
  const VertexProgram program(isa::load("vs_1_1\n" + text, "test"), arithmetic);
  Batches batch;
  std::memset(batch.in.get(), 0, sizeof(InputBatch));
  for (int c = 0; c < 4; ++c) batch.in->v[0][c][0] = static_cast<float>(c + 1);
  std::vector<Vec4> constants;
  for (int i = 0; i < 4; ++i)
    constants.push_back({10.0f + static_cast<float>(i), 20.0f + static_cast<float>(i),
                         30.0f + static_cast<float>(i), 40.0f + static_cast<float>(i)});
  program.run(constants, *batch.in, *batch.out, 1);
  const auto& o = batch.out->o[output];
  return {o[0][0], o[1][0], o[2][0], o[3][0]};
}

TEST(VertexProgram, SwizzleNegationAndMask) {
  EXPECT_EQ(run("mov oPos, -v0.wzyx", oPos), (Vec4{-4, -3, -2, -1}));
  EXPECT_EQ(run("mov r0, v0\nmov r0.yw, c1.x\nmov oPos, r0", oPos), (Vec4{1, 11, 3, 11}));
}

TEST(VertexProgram, ADestinationMayBeItsOwnSwizzledSource) {
  EXPECT_EQ(run("mov r0, v0\nadd r0, r0.wzyx, r0\nmov oPos, r0", oPos), (Vec4{5, 5, 5, 5}));
  EXPECT_EQ(run("mov r0, v0\nmov r0, r0.yzwx\nmov oPos, r0", oPos), (Vec4{2, 3, 4, 1}));
}

// RCP and RSQ alone are rounded, in both arithmetics, by every way to run a program.
TEST(VertexProgram, ReciprocalsOfFewerBits) {
  const isa::Program text = isa::load(
      "vs_1_1\nrcp r0.x, v0.z\nrsq r0.y, v0.y\nmul r0.z, v0.z, r0.x\n"
      "mov oPos, r0.xyzz",
      "test");
  Batches batch;
  std::memset(batch.in.get(), 0, sizeof(InputBatch));
  for (int c = 0; c < 4; ++c) batch.in->v[0][c][0] = static_cast<float>(c + 1);
  for (const Arithmetic arithmetic : {Arithmetic::ieee, Arithmetic::nv20}) {
    const VertexProgram program(text, arithmetic, 9);
    const auto& o = batch.out->o[oPos];
    for (const bool scalar : {false, true}) {
      scalar ? program.run_scalar({}, *batch.in, *batch.out, 1) : program.run({}, *batch.in, *batch.out, 1);
      EXPECT_EQ(o[0][0], 0x155p-10f);  // 1/3 = 0.0101010101|01...b
      EXPECT_EQ(o[1][0], 0x16ap-9f);   // 1/sqrt 2 = 0.101101010|000...b
      EXPECT_EQ(o[2][0], 3 * 0x155p-10f);
      EXPECT_EQ(program.trace({}, *batch.in).back().outputs[oPos][0], 0x155p-10f);
    }
  }
}

TEST(VertexProgram, MatrixMacros) {
  EXPECT_EQ(run("m4x4 oPos, v0, c0", oPos), (Vec4{300, 310, 320, 330}));
  EXPECT_EQ(run("m3x2 r0.xy, v0, c2\nmov oPos, r0.xyxy", oPos), (Vec4{152, 158, 152, 158}));
}

TEST(VertexProgram, RelativeAddressesFloorAndReadZeroOutside) {
  EXPECT_EQ(run("def c9, 1.9, -1.5, 95, 200\nmov a0.x, c9.x\nmov oPos, c[a0.x + 1]", oPos),
            (Vec4{12, 22, 32, 42}));
  EXPECT_EQ(run("def c9, 1.9, -1.5, 95, 200\nmov a0.x, c9.y\nmov oPos, c[a0.x + 2]", oPos),
            (Vec4{10, 20, 30, 40}));
  EXPECT_EQ(run("def c9, 1.9, -1.5, 95, 200\nmov a0.x, c9.y\nmov oPos, c[a0.x + 1]", oPos),
            (Vec4{0, 0, 0, 0}));
  EXPECT_EQ(run("def c9, 1.9, -1.5, 95, 200\nmov a0.x, c9.x\nmov oPos, c[a0.x + 60]", oPos),
            (Vec4{0, 0, 0, 0}));  // not given
  EXPECT_EQ(run("def c9, 1.9, -1.5, 95, 200\nmov a0.x, c9.w\nmov oPos, c[a0.x]", oPos), (Vec4{0, 0, 0, 0}));
  EXPECT_EQ(run("def c9, 1.9, -1.5, 95, 200\nmov a0.x, c9.z\nmov oPos, c[a0.x + 95]", oPos),
            (Vec4{0, 0, 0, 0}));
}

TEST(VertexProgram, AnAddressOfADenormalIsThatOfZeroInNv20) {
  for (const auto& [value, ieee] : {std::pair{"-1e-40", 10.0f}, {"1e-40", 11.0f}, {"-1e-37", 10.0f}}) {
    const std::string text = fmt::format("def c9, {}, 0, 0, 0\nmov a0.x, c9.x\nmov oPos, c[a0.x + 1]", value);
    EXPECT_EQ(run(text, oPos)[0], ieee) << value;
    EXPECT_EQ(run(text, oPos, Arithmetic::nv20)[0], std::string_view(value) == "-1e-37" ? 10 : 11) << value;
  }
}

TEST(VertexProgram, WhatIsNotWrittenIsZeroAndTheDiffuseColourOne) {
  EXPECT_EQ(run("mov oPos, v0", oD0), (Vec4{1, 1, 1, 1}));
  EXPECT_EQ(run("mov oPos, v0\nmov oD0.a, v0.x", oD0), (Vec4{1, 1, 1, 1}));
  EXPECT_EQ(run("mov oPos, v0\nmov oT0.xy, v0", oT0), (Vec4{1, 2, 0, 0}));
}

// A random valid program over r0..r5, v0, v1, c0..c7.
class RandomProgram {
 public:
  explicit RandomProgram(std::mt19937& random) : random_(random) {}

  std::string text() {
    std::string result = "vs_1_1\nmov a0.x, c0.x\n";
    for (int r = 0; r < 6; ++r)
      result += fmt::format("mov r{}, {}\n", r, r % 3 == 0 ? "v0" : r % 3 == 1 ? "v1" : "c1");
    for (int i = 0; i < 40; ++i) result += instruction();
    for (int r = 0; r < 6; ++r) result += fmt::format("mov oT{}, r{}\n", r, r);
    return result + "mov oPos, r0\n";
  }

 private:
  int pick(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }

  std::string swizzle(int letters) {
    std::string result = ".";
    for (int i = 0; i < letters; ++i) result += "xyzw"[pick(4)];
    return result;
  }

  std::string source(int kind, bool scalar) {
    const std::string names[] = {fmt::format("r{}", pick(6)), input_, constant_};
    return (pick(2) ? "-" : "") + names[kind] + (scalar ? swizzle(1) : pick(2) ? swizzle(4) : "");
  }

  std::string instruction() {
    const auto opcodes = isa::opcode_table();
    const isa::OpcodeInfo* info = nullptr;
    while (info == nullptr || info->kind != isa::ShaderKind::vertex || info->opcode == isa::Opcode::nop ||
           isa::matrix_shape(info->opcode).rows > 0)
      info = &opcodes[static_cast<std::size_t>(pick(static_cast<int>(opcodes.size())))];
    using enum isa::Opcode;
    const auto op = info->opcode;
    const bool scalar = op == rcp || op == rsq || op == exp || op == expp || op == log || op == logp;
    input_ = pick(4) ? "v1" : "v0";  // an instruction reads one input register
    constant_ = pick(4) ? fmt::format("c{}", pick(8)) : fmt::format("c[a0.x + {}]", pick(8));
    const std::string_view masks[] = {"", ".x", ".yz", ".xw", ".yzw", ".xy"};
    std::string result = fmt::format("{} r{}{}", info->name, pick(6), op == frc ? ".xy" : masks[pick(6)]);
    for (std::size_t i = 0; i < info->source_count; ++i) result += ", " + source(pick(3), scalar);
    return result + "\n";
  }

  std::mt19937& random_;
  std::string constant_, input_;
};

enum class Values { special, moderate, finite };

// special: half of them zeros, denormals, infinities, NaN, powers of two or extremes, and a quarter any bits;
// moderate: -4 to 4; finite: any exponent, so sums and products overflow and underflow.
float random_value(std::mt19937& random, Values values) {
  constexpr std::uint32_t kSpecial[] = {0x00000000, 0x80000000, 0x00000001, 0x807fffff, 0x00800000,
                                        0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000, 0x7fc00000,
                                        0xffc12345, 0x7f800001, 0x3f800000, 0xbf800000, 0x3f7fffff,
                                        0x40000000, 0x43000000, 0xc3160000};
  if (values == Values::finite)
    return std::bit_cast<float>(static_cast<std::uint32_t>(random()) & 0xff7fffffu);
  switch (values == Values::special ? random() % 4 : 2) {
    case 0:
      return std::bit_cast<float>(kSpecial[random() % std::size(kSpecial)]);
    case 1:
      return std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    default:
      return std::uniform_real_distribution<float>(-4, 4)(random);
  }
}

void expect_same_bits(const OutputBatch& is, const OutputBatch& expected, int count) {
  for (int o = 0; o < kOutputs; ++o)
    for (int c = 0; c < 4; ++c)
      for (int lane = 0; lane < count; ++lane)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(is.o[o][c][lane]),
                  std::bit_cast<std::uint32_t>(expected.o[o][c][lane]))
            << "output " << o << '.' << c << ", vertex " << lane;
}

// The vertices of each group agree in v1.
void compare_simd_targets_with_scalar(Arithmetic arithmetic) {
  std::mt19937 random(random_seed());
  for (int trial = 0; trial < 100; ++trial) {
    const auto value = [&] { return random_value(random, static_cast<Values>(trial % 3)); };
    const std::string text = RandomProgram(random).text();
    SCOPED_TRACE(text);
    const VertexProgram program(isa::assemble(text, "random"), arithmetic);
    std::vector<Vec4> constants(8);
    for (Vec4& constant : constants)
      for (float& component : constant) component = value();
    Batches batch;
    VertexProgram::Bound bound(program, constants);
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t lane = 0; lane < kBatch; ++lane) {
        batch.in->v[0][c][lane] = bound.input().v[0][c][lane] = value();
        if (lane % kGroup == 0) bound.grouped_input().v[1][c][lane / kGroup] = value();
        batch.in->v[1][c][lane] = bound.grouped_input().v[1][c][lane / kGroup];
      }
    }
    const auto scalar = std::make_unique<OutputBatch>();
    const int count = 1 + static_cast<int>(random() % kBatch), whole_groups = count / kGroup * kGroup;
    program.run_scalar(constants, *batch.in, *scalar, count);
    testing::on_each_simd_target([&] {
      program.run(constants, *batch.in, *batch.out, count);
      expect_same_bits(*batch.out, *scalar, count);
      bound.run(whole_groups, 0b10);
      expect_same_bits(bound.output(), *scalar, whole_groups);
    });
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(VertexProgram, EverySimdTargetGivesTheBitsOfTheScalarInterpreterInIeee) {
  compare_simd_targets_with_scalar(Arithmetic::ieee);
}

TEST(VertexProgram, EverySimdTargetGivesTheBitsOfTheScalarInterpreterInNv20) {
  compare_simd_targets_with_scalar(Arithmetic::nv20);
}

}  // namespace
}  // namespace splatscope::vertex
