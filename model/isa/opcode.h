#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "model/isa/program.h"

// The instruction table: one row an instruction and version range. Text, tokens and validator read the same
// rows.
namespace splatscope::isa {

enum class OpcodeClass : std::uint8_t { arithmetic, texture, flow };

struct OpcodeInfo {
  Opcode opcode;
  std::string_view name;
  std::uint16_t token;  // low 16 bits of D3DSHADER_INSTRUCTION_OPCODE_TYPE
  ShaderKind kind;
  int first_minor, last_minor;  // versions 1.first .. 1.last
  bool has_destination;
  std::size_t source_count;
  int slots;
  OpcodeClass unit;
};

std::span<const OpcodeInfo> opcode_table();

// The row for this version, or nullptr.
const OpcodeInfo* find_opcode(Version version, std::string_view name);
const OpcodeInfo* find_opcode(Version version, std::uint16_t token);
const OpcodeInfo* find_opcode(Version version, Opcode opcode);

// "vs_1_1"
std::string to_string(Version version);

// Rows of a matrix macro (m4x4: 4) and the components of its dot products (m3x2: 3); 0 for other
// instructions.
struct MatrixShape {
  int rows;
  int columns;
};
MatrixShape matrix_shape(Opcode opcode);

// Rows of the matrix that a texture instruction has one of, its pads and the last (texm3x2*: 2); 0 for
// others.
int texture_matrix_rows(Opcode opcode);

// Limits of the machines of 2002 (Direct3D 8.1 reference; caps of GeForce3/4 and Radeon 8500).
inline constexpr int kVertexConstants = 96;
inline constexpr int kVertexInputs = 16;
inline constexpr int kVertexTemporaries = 12;
inline constexpr int kVertexSlots = 128;
inline constexpr int kMaximumIndex = 2047;  // 11 bits of a register token

}  // namespace splatscope::isa
