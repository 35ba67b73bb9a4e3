#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/register_names.h"
#include "model/isa/rules.h"
#include "model/isa/validate.h"

// vs_1_1, by the Direct3D reference ("Registers - vs_1_1", "Destination Register Masking", the page of each
// instruction). Where its pages disagree, the instruction's own page holds.
namespace splatscope::isa {
namespace {

bool is_scalar(Opcode opcode) {
  using enum Opcode;
  return opcode == rcp || opcode == rsq || opcode == exp || opcode == expp || opcode == log || opcode == logp;
}

class VertexValidator {
 public:
  explicit VertexValidator(const Program& program) : program_(program) {}

  void run() {
    check_setup();
    for (const Instruction& instruction : program_.instructions) {
      check_instruction(instruction);
      record_write(instruction);
    }
    check_outputs();
  }

 private:
  void check_setup() const {
    for (const Definition& definition : program_.definitions)
      if (definition.index >= kVertexConstants)
        throw UserError(
            program_.name, definition.line, definition.column,
            fmt::format("c{} does not exist, expected c0 to c{}", definition.index, kVertexConstants - 1));
    for (const Declaration& declaration : program_.declarations) {
      if (declaration.destination.file != RegisterFile::input ||
          declaration.destination.index >= kVertexInputs)
        throw UserError(program_.name, declaration.line, declaration.column,
                        "dcl declares an input, expected v0 to v15");
    }
  }

  void check_instruction(const Instruction& instruction) {
    slots_ += find_opcode(program_.version, instruction.opcode)->slots;
    if (slots_ > kVertexSlots)
      reject(program_, instruction, fmt::format("more than {} instruction slots", kVertexSlots));
    if (instruction.coissue) reject(program_, instruction, "vs_1_1 has no co-issue ('+')");
    if (instruction.opcode == Opcode::nop) return;
    check_destination(instruction);
    const Instruction read = as_read(instruction);
    for (std::size_t i = 0; i < read.source_count; ++i) check_source(read, i);
    check_read_ports(program_, instruction, RegisterFile::constant, 1);
    check_read_ports(program_, instruction, RegisterFile::input, 1);
    if (is_scalar(instruction.opcode) && !is_replicated(instruction.sources[0]))
      reject(program_, instruction,
             "the source of a scalar instruction needs one component, expected .x .y .z or .w");
    if (instruction.opcode == Opcode::frc && instruction.destination.mask != 0x2 &&
        instruction.destination.mask != 0x3)
      reject(program_, instruction, "frc writes .y or .xy");
    if (matrix_shape(instruction.opcode).rows > 0) check_matrix(instruction);
  }

  void check_destination(const Instruction& instruction) const {
    const Destination& destination = instruction.destination;
    if (destination.saturate || destination.shift != 0)
      reject(program_, instruction, "vs_1_1 has no destination modifiers (_sat, _x2, ...)");
    if (destination.mask == 0 || destination.mask > 0xf)
      reject(program_, instruction, "the write mask is empty");
    switch (destination.file) {
      case RegisterFile::temporary:
        return check_index(instruction, destination.file, destination.index, kVertexTemporaries);
      case RegisterFile::color_out:
        return check_index(instruction, destination.file, destination.index, 2);
      case RegisterFile::texcoord_out:
        return check_index(instruction, destination.file, destination.index, 8);
      case RegisterFile::position_out:
        return;
      case RegisterFile::fog_out:
      case RegisterFile::point_size_out:
        if ((destination.mask & (destination.mask - 1)) != 0 && destination.mask != 0xf)
          reject(program_, instruction, "oFog and oPts are scalars: their mask names one component");
        return;
      case RegisterFile::address:
        check_index(instruction, destination.file, destination.index, 1);
        if (instruction.opcode != Opcode::mov)
          reject(program_, instruction, "only mov writes the address register");
        if (destination.mask != 0x1)
          reject(program_, instruction, "the address register has one component, expected a0.x");
        return;
      default:
        reject(program_, instruction,
               fmt::format("{} cannot be written", register_name(destination.file, destination.index)));
    }
  }

  void check_index(const Instruction& instruction, RegisterFile file, int index, int count) const {
    if (index >= count)
      reject(program_, instruction,
             fmt::format("{} does not exist, expected {} to {}", register_name(file, index),
                         register_name(file, 0), register_name(file, count - 1)));
  }

  void check_source(const Instruction& instruction, std::size_t number) const {
    const Source& source = instruction.sources[number];
    const int rows = number == 1 ? std::max(1, matrix_shape(instruction.opcode).rows) : 1;
    if (source.modifier != SourceModifier::none)
      reject(program_, instruction, "vs_1_1 has no source modifier but negation");
    if (source.relative && source.file != RegisterFile::constant)
      reject(program_, instruction, "only c# can be addressed relative to a0.x");
    if (source.relative && !address_written_)
      reject(program_, instruction, "a0.x is read before it is written");
    // Where the rows of a relative matrix lie shows when it runs: what is no constant reads as 0.
    const int last = source.relative ? source.index : source.index + rows - 1;
    switch (source.file) {
      case RegisterFile::constant:
        return check_index(instruction, source.file, last, kVertexConstants);
      case RegisterFile::input:
        return check_index(instruction, source.file, last, kVertexInputs);
      case RegisterFile::temporary:
        check_index(instruction, source.file, last, kVertexTemporaries);
        for (int index = source.index; index <= last; ++index)
          if (!is_written(instruction, number, index))
            reject(program_, instruction,
                   fmt::format("r{} is read before it is written (all the components read)", index));
        return;
      default:
        reject(program_, instruction,
               fmt::format("{} cannot be read", register_name(source.file, source.index)));
    }
  }

  bool is_written(const Instruction& instruction, std::size_t source, int index) const {
    return (components_read(instruction, source) & ~written_[static_cast<std::size_t>(index)]) == 0;
  }

  // What is written of an output is what is read for it: of a scalar one component, the first that can be.
  Instruction as_read(Instruction instruction) const {
    Destination& destination = instruction.destination;
    if (!is_scalar_output(destination.file) || destination.mask != 0xf) return instruction;
    for (int component = 0; component < 4; ++component) {
      destination.mask = static_cast<std::uint8_t>(1 << component);
      bool all = true;
      for (std::size_t i = 0; i < instruction.source_count; ++i) {
        const Source& source = instruction.sources[i];
        if (source.file == RegisterFile::temporary && source.index < kVertexTemporaries)
          all = all && is_written(instruction, i, source.index);
      }
      if (all) return instruction;
    }
    destination.mask = 0xf;
    return instruction;
  }

  void check_matrix(const Instruction& instruction) const {
    const auto [rows, columns] = matrix_shape(instruction.opcode);
    const Destination& destination = instruction.destination;
    const Source& vector = instruction.sources[0];
    const Source& matrix = instruction.sources[1];
    const unsigned expected = (1u << rows) - 1;
    if (destination.mask != expected)
      reject(program_, instruction,
             fmt::format("this macro needs the write mask .{}",
                         std::string_view("xyzw").substr(0, static_cast<std::size_t>(rows))));
    if (is_scalar_output(destination.file))
      reject(program_, instruction, "oFog and oPts are scalars, a macro writes several components");
    if (matrix.negate || matrix.swizzle != kIdentity)
      reject(program_, instruction, "the matrix of a macro takes no swizzle and no negation");
    const auto overlaps = [&](const Source& source, int count) {
      return source.file == destination.file && destination.index >= source.index &&
             destination.index < source.index + count;
    };
    if (overlaps(vector, 1) || overlaps(matrix, rows))
      reject(program_, instruction, "the destination of a macro cannot be one of its sources");
    if (vector.file == matrix.file && vector.file != RegisterFile::temporary)
      reject(program_, instruction,
             "this macro reads two different registers of one file with one read port");
  }

  void record_write(const Instruction& instruction) {
    const Destination& destination = instruction.destination;
    const unsigned mask = destination.mask;
    if (instruction.opcode == Opcode::nop) return;
    switch (destination.file) {
      case RegisterFile::temporary:
        written_[destination.index] |= mask;
        break;
      case RegisterFile::address:
        address_written_ = true;
        break;
      case RegisterFile::position_out:
        position_ |= mask;
        break;
      case RegisterFile::texcoord_out:
        texcoords_[destination.index] |= mask;
        texcoord_writers_[destination.index] = &instruction;
        break;
      default:
        break;
    }
  }

  void check_outputs() const {
    const Instruction& last = program_.instructions.back();
    if (position_ != 0xf)
      reject(program_, last, "oPos is not written, expected all four components by the end");
    bool missing = false;
    for (std::size_t i = 0; i < texcoords_.size(); ++i) {
      const unsigned mask = texcoords_[i];
      if (mask != 0 && missing)
        reject(program_, *texcoord_writers_[i],
               fmt::format("oT{} is written but not every oT# before it", i));
      if (mask != 0 && (mask & (mask + 1)) != 0)
        reject(program_, *texcoord_writers_[i],
               fmt::format("the components of oT{} written in all must be .x .xy .xyz or .xyzw", i));
      missing = missing || mask == 0;
    }
  }

  const Program& program_;
  int slots_ = 0;
  bool address_written_ = false;
  WrittenComponents written_{};
  unsigned position_ = 0;
  std::array<unsigned, 8> texcoords_{};
  std::array<const Instruction*, 8> texcoord_writers_{};  // the last of each
};

}  // namespace

void validate_vertex(const Program& program) {
  VertexValidator(program).run();
}

}  // namespace splatscope::isa
