#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "model/isa/program.h"

// Bit fields of the tokens, for the reader and the writer. Internal to model/isa.
namespace splatscope::isa {

inline constexpr std::uint32_t kVertexVersion = 0xfffe0000u;
inline constexpr std::uint32_t kPixelVersion = 0xffff0000u;
inline constexpr std::uint32_t kEndToken = 0x0000ffffu;
inline constexpr std::uint32_t kCommentOpcode = 0xfffeu;
inline constexpr std::uint32_t kDefinitionOpcode = 0x51u;
inline constexpr std::uint32_t kDeclarationOpcode = 0x1fu;
inline constexpr std::uint32_t kCoissueBit = 0x40000000u;
inline constexpr std::uint32_t kParameterBit = 0x80000000u;
inline constexpr std::uint32_t kRelativeBit = 0x2000u;
inline constexpr std::uint32_t kSaturateBit = 0x00100000u;

// The D3DSHADER_PARAM_REGISTER_TYPE of each register file; "rasterizer outputs" oPos, oFog, oPts share one.
struct RegisterType {
  std::uint32_t type;
  std::uint32_t index;  // of rasterizer outputs
};

constexpr RegisterType register_type(RegisterFile file, std::uint32_t index) {
  switch (file) {
    case RegisterFile::temporary:
      return {0, index};
    case RegisterFile::input:
      return {1, index};
    case RegisterFile::constant:
      return {2, index};
    case RegisterFile::address:
    case RegisterFile::texture:
      return {3, index};
    case RegisterFile::position_out:
      return {4, 0};
    case RegisterFile::fog_out:
      return {4, 1};
    case RegisterFile::point_size_out:
      return {4, 2};
    case RegisterFile::color_out:
      return {5, index};
    case RegisterFile::texcoord_out:
      return {6, index};
  }
  return {7, index};
}

constexpr std::optional<RegisterFile> register_file(ShaderKind kind, std::uint32_t type,
                                                    std::uint32_t index) {
  using enum RegisterFile;
  switch (type) {
    case 0:
      return temporary;
    case 1:
      return input;
    case 2:
      return constant;
    case 3:
      return kind == ShaderKind::vertex ? address : texture;
    default:
      break;
  }
  if (kind == ShaderKind::pixel) return std::nullopt;
  if (type == 4 && index < 3) return std::array{position_out, fog_out, point_size_out}[index];
  if (type == 5) return color_out;
  if (type == 6) return texcoord_out;
  return std::nullopt;
}

// D3DSHADER_PARAM_SRCMOD_TYPE: modifier and negation together.
struct SourceModifierCode {
  SourceModifier modifier;
  bool negate;
};
inline constexpr std::array<SourceModifierCode, 11> kSourceModifiers = {{{SourceModifier::none, false},
                                                                         {SourceModifier::none, true},
                                                                         {SourceModifier::bias, false},
                                                                         {SourceModifier::bias, true},
                                                                         {SourceModifier::bx2, false},
                                                                         {SourceModifier::bx2, true},
                                                                         {SourceModifier::invert, false},
                                                                         {SourceModifier::x2, false},
                                                                         {SourceModifier::x2, true},
                                                                         {SourceModifier::dz, false},
                                                                         {SourceModifier::dw, false}}};

}  // namespace splatscope::isa
