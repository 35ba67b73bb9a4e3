#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/pixel_limits.h"
#include "model/isa/register_names.h"
#include "model/isa/rules.h"
#include "model/isa/validate.h"

// ps_1_1 to ps_1_4, by the Direct3D reference ("Registers", "Modifiers", "Destination Register Write Mask",
// "Source Register Swizzling" of ps_1_x, and the page of each instruction).
namespace splatscope::isa {
namespace {

using enum Opcode;

constexpr std::array<std::uint8_t, 4> kXyz{0, 1, 2, 2}, kXyw{0, 1, 3, 3};
constexpr std::array<std::uint8_t, 4> kBlue{2, 2, 2, 2}, kAlpha{3, 3, 3, 3};

class PixelValidator {
 public:
  explicit PixelValidator(const Program& program)
      : program_(program), limits_(pixel_limits(program.version)), version_1_4_(program.version.minor == 4) {
    has_phase_ =
        std::ranges::any_of(program.instructions, [](const Instruction& i) { return i.opcode == phase; });
  }

  void run() {
    for (const Definition& definition : program_.definitions)
      if (definition.index >= kPixelConstants)
        throw UserError(program_.name, definition.line, definition.column,
                        fmt::format("c{} does not exist, expected c0 to c7", definition.index));
    if (!program_.declarations.empty())
      throw UserError(program_.name, program_.declarations[0].line, program_.declarations[0].column,
                      "dcl is of vertex programs");
    for (std::size_t at = 0; at < program_.instructions.size(); ++at) {
      const Instruction& instruction = program_.instructions[at];
      if (instruction.coissue) check_pair(at);
      if (instruction.opcode == nop) continue;
      instruction.opcode == phase ? begin_phase_2(instruction) : check_instruction(at);
    }
    if (pads_ != 0)
      reject(program_, program_.instructions.back(), "a texm3x2pad or texm3x3pad lacks its last row");
    if (written_[0] != 0xf)
      reject(program_, program_.instructions.back(),
             "r0 is the result: expected all four components written by the end");
  }

 private:
  void begin_phase_2(const Instruction& instruction) {
    if (phase_marker_seen_) reject(program_, instruction, "a program has one phase marker");
    phase_marker_seen_ = true;
    arithmetic_slots_ = texture_slots_ = 0;
    arithmetic_begun_ = false;
    for (unsigned& components : written_) components &= 0x7;  // alpha does not survive the marker
    before_phase_ = written_;
  }

  bool in_phase_1() const { return has_phase_ && !phase_marker_seen_; }

  void check_instruction(std::size_t at) {
    const Instruction& instruction = program_.instructions[at];
    const OpcodeInfo& info = *find_opcode(program_.version, instruction.opcode);
    const bool texture = info.unit == OpcodeClass::texture;
    check_registers(instruction, info);
    check_occurrences(instruction);
    texture ? check_texture(instruction) : check_arithmetic(instruction);
    check_reads(at);
    check_slots(at, info, texture);
    texture ? record_texture(instruction) : record_arithmetic(at);
  }

  void check_registers(const Instruction& instruction, const OpcodeInfo& info) const {
    const auto check = [&](RegisterFile file, int index) {
      const int count = limits_.count(file);
      if (index >= count)
        reject(
            program_, instruction,
            fmt::format("{} does not exist in {}, expected {} to {}", register_name(file, index),
                        to_string(program_.version), register_name(file, 0), register_name(file, count - 1)));
    };
    if (info.has_destination) check(instruction.destination.file, instruction.destination.index);
    for (const Source& source : instruction.used_sources()) {
      check(source.file, source.index);
      if (source.relative) reject(program_, instruction, "a pixel program has no relative addresses");
      if (source.negate && source.modifier == SourceModifier::invert)
        reject(program_, instruction, "inversion (1 - x) cannot be combined with negation");
    }
    using enum RegisterFile;
    for (const RegisterFile file : {constant, temporary, input, RegisterFile::texture})
      check_read_ports(program_, instruction, file, limits_.read_ports(file));
  }

  // Instructions that may occur only so often.
  void check_occurrences(const Instruction& instruction) {
    if (instruction.opcode == cmp && !version_1_4_ && ++comparisons_ > 3)
      reject(program_, instruction, "a program has at most three cmp instructions in ps_1_2 and ps_1_3");
    if (instruction.opcode == dp4 && !version_1_4_ && ++dot_products_ > 4)
      reject(program_, instruction, "a program has at most four dp4 instructions in ps_1_2 and ps_1_3");
    if (instruction.opcode == bem && ++bumps_ > 1)
      reject(program_, instruction, "a program has at most one bem");
    for (const Source& source : instruction.used_sources())
      if (source.modifier == SourceModifier::dz && ++divisions_ > 2)
        reject(program_, instruction, "a program uses _dz at most twice");
  }

  void check_slots(std::size_t at, const OpcodeInfo& info, bool texture) {
    const Instruction& instruction = program_.instructions[at];
    if (texture) {
      texture_slots_ += 1;
      arithmetic_slots_ += info.slots - 1;  // texbeml
    } else {
      arithmetic_slots_ += slots_at(program_, at);
    }
    const std::string where = version_1_4_ ? " in a phase" : "";
    if (texture_slots_ > limits_.texture_slots)
      reject(program_, instruction,
             fmt::format("more than {} texture address instructions{}", limits_.texture_slots, where));
    if (arithmetic_slots_ > kPixelArithmeticSlots)
      reject(program_, instruction,
             fmt::format("more than {} arithmetic instruction slots{}", kPixelArithmeticSlots, where));
  }

  void check_arithmetic(const Instruction& instruction) const {
    const Destination& destination = instruction.destination;
    const bool writes_texture = destination.file == RegisterFile::texture && !version_1_4_;
    if (destination.file != RegisterFile::temporary && !writes_texture)
      reject(program_, instruction,
             fmt::format("an arithmetic instruction cannot write {}",
                         register_name(destination.file, destination.index)));
    if (!version_1_4_ && destination.mask != 0xf && destination.mask != 0x7 && destination.mask != 0x8)
      reject(program_, instruction, "the write mask must be .rgba, .rgb or .a before ps_1_4");
    if (!version_1_4_ && instruction.opcode == dp3 && destination.mask == 0x8)
      reject(program_, instruction, "dp3 writes .rgb or .rgba before ps_1_4");
    if (!version_1_4_ && (destination.shift < -1 || destination.shift > 2))
      reject(program_, instruction, "_x8, _d4 and _d8 need ps_1_4");
    for (const Source& source : instruction.used_sources()) check_arithmetic_source(instruction, source);
    if (instruction.opcode == cnd && !version_1_4_) {
      const Source& condition = instruction.sources[0];
      if (condition != Source{RegisterFile::temporary, 0, kAlpha})
        reject(program_, instruction, "the condition of cnd is r0.a before ps_1_4");
    }
    if (instruction.opcode == cmp && !version_1_4_) {
      for (const Source& source : instruction.used_sources())
        if (source.file == destination.file && source.index == destination.index)
          reject(program_, instruction, "the destination of cmp cannot be one of its sources before ps_1_4");
    }
    if (instruction.opcode == bem && (destination.mask != 0x3 || !in_phase_1()))
      reject(program_, instruction, "bem writes .rg, in the first phase");
    if (instruction.opcode == bem && instruction.sources[1].file != RegisterFile::temporary)
      reject(program_, instruction, "the second source of bem is r#");
  }

  void check_arithmetic_source(const Instruction& instruction, const Source& source) const {
    using enum SourceModifier;
    if (version_1_4_ && source.file == RegisterFile::texture)
      reject(program_, instruction, "an arithmetic instruction cannot read t# in ps_1_4");
    if (source.file == RegisterFile::input && in_phase_1())
      reject(program_, instruction, "v# can be read in the second phase only");
    if (source.modifier == dz || source.modifier == dw)
      reject(program_, instruction, "_dz and _dw are for texld and texcrd");
    if (source.modifier == x2 && !version_1_4_)
      reject(program_, instruction, "the source modifier _x2 needs ps_1_4");
    if (version_1_4_ && source.file == RegisterFile::constant && (source.negate || source.modifier != none))
      reject(program_, instruction, "a constant takes no source modifier in ps_1_4");
    if (version_1_4_) {
      if (source.swizzle != kIdentity && !is_replicated(source))
        reject(program_, instruction,
               "a source selects one component (.r .g .b .a) or all, ps_1_4 has no general swizzle");
    } else if (source.swizzle == kBlue) {
      if (instruction.destination.mask != 0x8)
        reject(program_, instruction, "the selector .b needs the write mask .a before ps_1_4");
    } else if (source.swizzle != kIdentity && source.swizzle != kAlpha) {
      reject(program_, instruction, "a source selects .a (or .b for the write mask .a) or all before ps_1_4");
    }
  }

  void check_texture(const Instruction& instruction) const {
    const Destination& destination = instruction.destination;
    if (arithmetic_begun_)
      reject(program_, instruction, "texture address instructions must precede arithmetic ones");
    if (destination.shift != 0 || destination.saturate)
      reject(program_, instruction, "a texture address instruction takes no destination modifier");
    if (instruction.coissue)
      reject(program_, instruction, "a texture address instruction cannot be co-issued");
    if (destination.mask != 0xf && instruction.opcode != texcrd)
      reject(program_, instruction, "a texture address instruction takes no write mask");
    version_1_4_ ? check_texture_1_4(instruction) : check_texture_to_1_3(instruction);
  }

  void check_texture_to_1_3(const Instruction& instruction) const {
    const int stage = instruction.destination.index;
    if (instruction.destination.file != RegisterFile::texture)
      reject(program_, instruction, "the destination of a texture address instruction is t#");
    if (stage <= last_stage_)
      reject(
          program_, instruction,
          fmt::format("t{} after t{}: texture address instructions stand in the order of their stages, one a "
                      "stage before ps_1_4",
                      stage, last_stage_));
    check_rows(instruction);
    if (instruction.source_count == 0) return;
    const Source& source = instruction.sources[0];
    if (source.file != RegisterFile::texture || source.swizzle != kIdentity)
      reject(program_, instruction, "the source of a texture address instruction is a whole t#");
    if (source.index >= stage)
      reject(program_, instruction,
             "the source of a texture address instruction is of an earlier stage than its destination");
    const bool matrix = texture_matrix_rows(instruction.opcode) > 0;
    const bool never = instruction.opcode == texreg2ar || instruction.opcode == texreg2gb;
    const bool scaled =
        source.modifier == SourceModifier::bx2 && !never && (matrix || program_.version.minor > 1);
    if (source.negate || (source.modifier != SourceModifier::none && !scaled))
      reject(program_, instruction,
             "this texture address instruction takes no source modifier here (_bx2: texm3x* in "
             "ps_1_1, any but texreg2ar and texreg2gb in ps_1_2 and ps_1_3)");
    if (instruction.opcode == texm3x3spec) {
      const Source& eye = instruction.sources[1];
      if (eye != Source{RegisterFile::constant, eye.index})
        reject(program_, instruction, "the eye ray of texm3x3spec is a constant c# without modifiers");
    }
  }

  void check_texture_1_4(const Instruction& instruction) const {
    const Destination& destination = instruction.destination;
    const bool kills_coordinates = instruction.opcode == texkill && destination.file == RegisterFile::texture;
    if (destination.file != RegisterFile::temporary && !kills_coordinates)
      reject(program_, instruction, "the destination of a texture address instruction is r# in ps_1_4");
    if (instruction.opcode == texdepth && (destination.index != 5 || in_phase_1()))
      reject(program_, instruction, "texdepth takes r5, in the second phase");
    if (instruction.opcode == texkill && in_phase_1())
      reject(program_, instruction, "texkill stands in the second phase");
    if (instruction.source_count == 0) return;
    const Source& source = instruction.sources[0];
    using enum SourceModifier;
    const bool coordinates = source.file == RegisterFile::texture;
    if (instruction.opcode == texcrd ? !coordinates : !coordinates && source.file != RegisterFile::temporary)
      reject(program_, instruction, "the source is t#, or r# for a texld of the second phase");
    if (source.modifier == dz && coordinates) reject(program_, instruction, "_dz is for r# sources of texld");
    if (source.modifier == dw && (!coordinates || source.swizzle != kXyw))
      reject(program_, instruction, "_dw is for t#_dw.xyw sources");
    if (source.negate || (source.modifier != none && source.modifier != dz && source.modifier != dw))
      reject(program_, instruction, "texld and texcrd take no source modifier but _dz and _dw");
    const bool whole = source.swizzle == kIdentity || source.swizzle == kXyz;
    if (!whole && !(coordinates && source.swizzle == kXyw))
      reject(program_, instruction, "the source of texld and texcrd selects .xyz, or .xyw of t#");
    if (coordinates && selectors_[source.index] && *selectors_[source.index] != whole)
      reject(program_, instruction,
             fmt::format("every read of t{} must select the same: .xyz or .xyw", source.index));
    if (instruction.opcode == texcrd && destination.mask != (source.modifier == dw ? 0x3 : 0x7))
      reject(program_, instruction, "texcrd writes .rgb, or .rg with _dw, never the fourth component");
  }

  // Matrix rows: texm3x2pad and its last row, texm3x3pad twice and its last row, in consecutive stages of one
  // source.
  void check_rows(const Instruction& instruction) const {
    const int rows = texture_matrix_rows(instruction.opcode);
    const bool pad = instruction.opcode == texm3x2pad || instruction.opcode == texm3x3pad;
    const bool first = pads_ == 0;
    if (rows == 0 && !first) reject(program_, instruction, "the rows of a matrix must follow one another");
    if (rows == 0) return;
    const bool last = pads_ == rows - 1;
    if (pad == last || (!first && pad_rows_ != rows))
      reject(program_, instruction, "a last row follows one texm3x2pad or two texm3x3pad");
    if (!first &&
        (instruction.destination.index != pad_stage_ + pads_ || instruction.sources[0].index != pad_source_))
      reject(program_, instruction, "the rows of a matrix are in consecutive stages and read the same t#");
  }

  // Every register read has been written; none is spent by texbem, texdepth or texm3x2depth.
  void check_reads(std::size_t at) const {
    const Instruction& instruction = program_.instructions[at];
    check_not_spent(instruction, instruction.destination);
    for (std::size_t i = 0; i < instruction.source_count; ++i) {
      const Source& source = instruction.sources[i];
      const unsigned read = components_read(instruction, i);
      check_not_spent(instruction, source);
      if (source.file == RegisterFile::temporary) {
        if (instruction.opcode == texld && !phase_marker_seen_)
          reject(program_, instruction, "texld reads r# in the second phase only, written in the first");
        if (instruction.opcode == texld && (read & ~before_phase_[source.index]) != 0)
          reject(program_, instruction,
                 fmt::format("texld reads r{0} as the first phase left it: not all that is read of it was "
                             "written there, or it is written again before",
                             source.index));
        check_temporary(instruction, source.index, read);
      } else if (source.file == RegisterFile::texture && !version_1_4_) {
        check_texture_register(instruction, source.index, read);
      }
    }
    const unsigned read = destination_components_read(instruction.opcode);
    if (version_1_4_ && read != 0 && instruction.destination.file == RegisterFile::temporary)
      check_temporary(instruction, instruction.destination.index, read);
  }

  // Of a source or destination: what has become the depth is no register any more.
  template <typename Operand>
  void check_not_spent(const Instruction& instruction, const Operand& operand) const {
    if (depth_ && operand.file == depth_->file && operand.index == depth_->index)
      reject(program_, instruction,
             fmt::format("{} cannot be used after {}", register_name(depth_->file, depth_->index),
                         version_1_4_ ? "texdepth" : "texm3x2depth"));
  }

  void check_temporary(const Instruction& instruction, std::size_t index, unsigned read) const {
    if (read & ~written_[index])
      reject(program_, instruction,
             fmt::format("r{} is read before it is written (all the components read)", index));
  }

  void check_texture_register(const Instruction& instruction, std::size_t index, unsigned read) const {
    const bool bump = instruction.opcode == texbem || instruction.opcode == texbeml;
    if (bumped_[index] && !bump)
      reject(program_, instruction,
             fmt::format("t{} has been read by texbem or texbeml and cannot be read again", index));
    if (read & ~texture_written_[index])
      reject(program_, instruction,
             fmt::format("t{} is read before it is written (all the components read)", index));
  }

  // The second half of a co-issued pair.
  void check_pair(std::size_t at) const {
    const Instruction& second = program_.instructions[at];
    const auto cannot = [](Opcode opcode) {
      return opcode == dp4 || opcode == bem || opcode == nop || opcode == phase;
    };
    if (at == 0 || program_.instructions[at - 1].coissue)
      reject(program_, second, "'+' pairs an instruction with the one before it");
    const Instruction& first = program_.instructions[at - 1];
    for (const Instruction* half : {&first, &second}) {
      const OpcodeInfo& info = *find_opcode(program_.version, half->opcode);
      if (cannot(half->opcode) || info.unit != OpcodeClass::arithmetic)
        reject(program_, second, fmt::format("{} cannot be co-issued", info.name));
      if (half->opcode == dp3 && half->destination.mask == 0x8)
        reject(program_, second, "dp3 runs in the colour pipe: it cannot be the alpha half of a pair");
    }
    const unsigned a = first.destination.mask, b = second.destination.mask;
    const bool color_and_alpha = (a == 0x8 && (b & 0x8) == 0) || (b == 0x8 && (a & 0x8) == 0);
    if (!color_and_alpha)
      reject(program_, second, "a pair writes colour (.rgb) with one half and .a with the other");
  }

  void record_arithmetic(std::size_t at) {
    arithmetic_begun_ = true;
    // Both halves of a pair read before either writes.
    const bool opens_pair = at + 1 < program_.instructions.size() && program_.instructions[at + 1].coissue;
    if (opens_pair) return;
    record_result(program_.instructions[at].destination);
    if (program_.instructions[at].coissue) record_result(program_.instructions[at - 1].destination);
  }

  void record_result(const Destination& destination) {
    if (destination.file == RegisterFile::temporary) {
      written_[destination.index] |= destination.mask;
    } else {
      texture_written_[destination.index] |= destination.mask;
      bumped_[destination.index] = false;
    }
  }

  void record_texture(const Instruction& instruction) {
    const Destination& destination = instruction.destination;
    const std::size_t index = destination.index;
    last_stage_ = destination.index;
    if (instruction.opcode == texdepth || instruction.opcode == texm3x2depth) depth_ = destination;
    if (instruction.opcode == texkill || instruction.opcode == texdepth) return;
    if (version_1_4_) {
      const Source& source = instruction.sources[0];
      if (source.file == RegisterFile::texture) selectors_[source.index] = source.swizzle != kXyw;
      written_[index] = destination.mask;  // texcrd leaves nothing in the other components
      if (phase_marker_seen_) before_phase_[index] = 0;
      return;
    }
    const int rows = texture_matrix_rows(instruction.opcode);
    const bool pad = instruction.opcode == texm3x2pad || instruction.opcode == texm3x3pad;
    if (pad && pads_ == 0) {
      pad_stage_ = destination.index;
      pad_source_ = instruction.sources[0].index;
      pad_rows_ = rows;
    }
    pads_ = pad ? pads_ + 1 : 0;
    texture_written_[index] = pad ? 0 : 0xf;
    if (instruction.opcode == texbem || instruction.opcode == texbeml)
      bumped_[instruction.sources[0].index] = true;
  }

  const Program& program_;
  PixelLimits limits_;
  bool version_1_4_;
  bool has_phase_ = false, phase_marker_seen_ = false;
  bool arithmetic_begun_ = false;
  std::optional<Destination> depth_;              // of texdepth or texm3x2depth
  int texture_slots_ = 0, arithmetic_slots_ = 0;  // of this phase
  int comparisons_ = 0, dot_products_ = 0, bumps_ = 0, divisions_ = 0;
  int last_stage_ = -1;  // of a texture address instruction
  int pads_ = 0, pad_rows_ = 0, pad_stage_ = 0, pad_source_ = 0;
  WrittenComponents written_{}, before_phase_{}, texture_written_{};
  std::array<bool, 8> bumped_{};
  std::array<std::optional<bool>, 8> selectors_{};  // of each t#: .xyz (or .xyw)
};

}  // namespace

void validate_pixel(const Program& program) {
  PixelValidator(program).run();
}

}  // namespace splatscope::isa
