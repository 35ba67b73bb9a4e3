#include "model/isa/analysis.h"

#include <algorithm>
#include <array>
#include <optional>

#include "model/isa/opcode.h"
#include "model/isa/register_names.h"
#include "model/isa/validate.h"

namespace splatscope::isa {
namespace {

// The row of a texture matrix that a stage of a pixel program gives the last one: behind all registers.
constexpr std::size_t kFirstRow = kRegisterBits - 4;
// First register of each kind.
constexpr std::size_t kAddress = kVertexTemporaries, kTextures = 13, kOutputs = 19;

std::size_t register_bit(RegisterFile file, std::size_t index, std::size_t component) {
  switch (file) {
    case RegisterFile::address:
      index += kAddress;
      break;
    case RegisterFile::texture:
      index += kTextures;
      break;
    case RegisterFile::position_out:
      index += kOutputs;
      break;
    case RegisterFile::fog_out:
      index += kOutputs + 1;
      break;
    case RegisterFile::point_size_out:
      index += kOutputs + 2;
      break;
    case RegisterFile::color_out:
      index += kOutputs + 3;
      break;
    case RegisterFile::texcoord_out:
      index += kOutputs + 5;
      break;
    default:
      break;
  }
  return 4 * index + component;
}

void include(RegisterSet& set, RegisterFile file, std::size_t index, unsigned components) {
  for (std::size_t component = 0; component < 4; ++component)
    if (components & (1u << component)) set.set(register_bit(file, index, component));
}

bool is_tracked(RegisterFile file) {
  return file != RegisterFile::input && file != RegisterFile::constant;
}

// Alpha of r0..r5 does not survive a phase marker.
RegisterSet lost_at_phase() {
  RegisterSet set;
  for (std::size_t index = 0; index < kVertexTemporaries; ++index)
    include(set, RegisterFile::temporary, index, 0x8);
  return set;
}

// What an instruction reads and writes, and whether it acts on more than registers (texkill, depth).
struct Effects {
  RegisterSet reads;
  RegisterSet writes;
  bool side_effect = false;
};

Effects effects_of(const Program& program, const Instruction& instruction) {
  Effects effects;
  using enum Opcode;
  if (instruction.opcode == nop) return effects;
  if (instruction.opcode == phase) {
    effects.writes = lost_at_phase();
    effects.side_effect = true;
    return effects;
  }
  for (std::size_t i = 0; i < instruction.source_count; ++i) {
    const Source& source = instruction.sources[i];
    if (source.relative) include(effects.reads, RegisterFile::address, 0, 0x1);
    const auto rows =
        static_cast<std::size_t>(i == 1 ? std::max(1, matrix_shape(instruction.opcode).rows) : 1);
    for (std::size_t row = 0; is_tracked(source.file) && row < rows; ++row)
      include(effects.reads, source.file, source.index + row, components_read(instruction, i));
  }
  const Destination& destination = instruction.destination;
  const Opcode opcode = instruction.opcode;
  effects.side_effect = opcode == texkill || opcode == texdepth || opcode == texm3x2depth;
  if (program.version.minor == 4)  // before, texkill looks at coordinates
    include(effects.reads, destination.file, destination.index, destination_components_read(opcode));
  if (opcode == texm3x2pad || opcode == texm3x3pad) {
    effects.writes.set(kFirstRow + destination.index);
    return effects;
  }
  for (int row = 1; row < texture_matrix_rows(opcode); ++row)
    effects.reads.set(kFirstRow + destination.index - static_cast<std::size_t>(row));
  if (opcode != texkill && opcode != texdepth)
    include(effects.writes, destination.file, destination.index, destination.mask);
  return effects;
}

RegisterSet live_at_the_end(const Program& program) {
  RegisterSet set;
  if (program.version.kind == ShaderKind::pixel)
    include(set, RegisterFile::temporary, 0, 0xf);
  else
    for (std::size_t bit = 4 * kOutputs; bit < kFirstRow; ++bit) set.set(bit);
  return set;
}

int live_temporaries(const RegisterSet& live) {
  int count = 0;
  for (std::size_t index = 0; index < kVertexTemporaries; ++index) {
    RegisterSet all;
    include(all, RegisterFile::temporary, index, 0xf);
    count += (live & all).any() ? 1 : 0;
  }
  return count;
}

// One step of the program: an instruction, or a co-issued pair, whose halves read before either writes.
std::size_t step_length(const Program& program, std::size_t at) {
  return at + 1 < program.instructions.size() && program.instructions[at + 1].coissue ? 2 : 1;
}

std::vector<std::size_t> step_starts(const Program& program) {
  std::vector<std::size_t> starts;
  for (std::size_t at = 0; at < program.instructions.size(); at += step_length(program, at))
    starts.push_back(at);
  return starts;
}

void find_liveness(const Program& program, Analysis& analysis) {
  RegisterSet live = live_at_the_end(program);
  const std::vector<std::size_t> starts = step_starts(program);
  for (auto start = starts.rbegin(); start != starts.rend(); ++start) {
    RegisterSet written, read;
    for (std::size_t k = 0; k < step_length(program, *start); ++k) {
      const Instruction& instruction = program.instructions[*start + k];
      InstructionAnalysis& result = analysis.instructions[*start + k];
      const Effects effects = effects_of(program, instruction);
      result.live_after = live;
      result.dead = !effects.side_effect && (effects.writes & live).none();
      written |= effects.writes;
      if (!result.dead) read |= effects.reads;
    }
    live = (live & ~written) | read;
    analysis.most_live_temporaries = std::max({analysis.most_live_temporaries, live_temporaries(live),
                                               live_temporaries(analysis.instructions[*start].live_after)});
  }
}

void find_critical_path(const Program& program, Analysis& analysis) {
  std::array<std::optional<std::size_t>, kRegisterBits>
      writers{};  // the last instruction that wrote a component
  std::vector<std::optional<std::size_t>> before(program.instructions.size());
  std::optional<std::size_t> last;
  for (const std::size_t start : step_starts(program)) {
    const std::size_t length = step_length(program, start);
    for (std::size_t place = start; place < start + length; ++place) {
      const Instruction& instruction = program.instructions[place];
      InstructionAnalysis& result = analysis.instructions[place];
      const RegisterSet reads = effects_of(program, instruction).reads;
      for (std::size_t bit = 0; bit < kRegisterBits; ++bit) {
        if (!reads[bit] || !writers[bit] || analysis.instructions[*writers[bit]].finish <= result.finish)
          continue;
        result.finish = analysis.instructions[*writers[bit]].finish;
        before[place] = writers[bit];
      }
      result.finish += find_opcode(program.version, instruction.opcode)->slots;
      if (!result.dead && (!last || result.finish > analysis.instructions[*last].finish)) last = place;
    }
    for (std::size_t place = start; place < start + length; ++place) {
      const RegisterSet writes = effects_of(program, program.instructions[place]).writes;
      for (std::size_t bit = 0; bit < kRegisterBits; ++bit)
        if (writes[bit]) writers[bit] = place;
    }
  }
  if (last) analysis.critical_slots = analysis.instructions[*last].finish;
  for (; last; last = before[*last]) analysis.critical_path.insert(analysis.critical_path.begin(), *last);
}

}  // namespace

std::string to_string(const RegisterSet& set) {
  std::string text;
  for (std::size_t index = 0; index < kOutputs; ++index) {
    std::string components;
    for (std::size_t component = 0; component < 4; ++component)
      if (set[4 * index + component]) components += "xyzw"[component];
    if (components.empty()) continue;
    text += text.empty() ? "" : " ";
    text += index < kAddress    ? register_name(RegisterFile::temporary, static_cast<int>(index))
            : index == kAddress ? "a0"
                                : register_name(RegisterFile::texture, static_cast<int>(index - kTextures));
    if (components != "xyzw") text += '.' + components;
  }
  return text;
}

Analysis analyze(const Program& program) {
  Analysis analysis;
  analysis.instructions.resize(program.instructions.size());
  find_liveness(program, analysis);
  find_critical_path(program, analysis);
  return analysis;
}

std::vector<bool> dependent_on(const Program& program, std::uint32_t inputs) {
  RegisterSet dependent;
  std::vector<bool> result;
  for (const Instruction& instruction : program.instructions) {
    const Effects effects = effects_of(program, instruction);
    const bool depends = (effects.reads & dependent).any() ||
                         std::ranges::any_of(instruction.used_sources(), [&](const Source& s) {
                           return s.file == RegisterFile::input && (inputs >> s.index & 1u) != 0;
                         });
    dependent = depends ? dependent | effects.writes : dependent & ~effects.writes;
    result.push_back(depends);
  }
  return result;
}

}  // namespace splatscope::isa
