#include "studies/shader_debugger.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <istream>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/register_names.h"
#include "model/isa/tokens.h"
#include "model/pixel/registers.h"
#include "model/stop.h"
#include "traces/words.h"

namespace splatscope::studies {
namespace {

constexpr std::string_view kHelp =
    "step [N]       the next instruction, or N: what it reads, and what it writes before and after\n"
    "back [N]       undo the last instruction, or N\n"
    "run LINE       up to the instruction of that line\n"
    "continue       to the end, or until a watched register changes\n"
    "watch NAME     stop `continue` where the register changes; unwatch NAME\n"
    "print [NAME]   registers, or all that the program writes\n"
    "list           the program; > is the next instruction\n"
    "restart, help, quit\n";

std::string text_of(const Vec4& value) {
  std::string numbers, bits;
  for (const float component : value) {
    numbers += fmt::format("{}{:.7g}", numbers.empty() ? "" : ", ", component);
    bits += fmt::format(" {:08x}", std::bit_cast<std::uint32_t>(component));
  }
  return fmt::format("({})  {}", numbers, bits.substr(1));
}

int number_of(const std::string& text) {
  const auto number = traces::number_of<int>(text);
  if (!number || *number < 1)
    throw std::invalid_argument(fmt::format("'{}', expected a whole number from 1 to 2147483647", text));
  return *number;
}

const std::string kDepth = "depth";  // that a pixel program writes

bool bumps(isa::Opcode opcode) {
  return opcode == isa::Opcode::bem || opcode == isa::Opcode::texbem || opcode == isa::Opcode::texbeml;
}

bool same_bits(const Vec4& a, const Vec4& b) {
  using Bits = std::array<std::uint32_t, 4>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

std::string output_name(int output) {
  using enum isa::RegisterFile;
  if (output == vertex::oPos) return register_name(position_out, 0);
  if (output == vertex::oFog) return register_name(fog_out, 0);
  if (output == vertex::oPts) return register_name(point_size_out, 0);
  return output < vertex::oT0 ? register_name(color_out, output - vertex::oD0)
                              : register_name(texcoord_out, output - vertex::oT0);
}

}  // namespace

ShaderDebugger::ShaderDebugger(isa::Program program, const ShaderCase& registers, Arithmetic arithmetic,
                               int reciprocal_bits)
    : program_(std::move(program)), constants_(registers.constants()) {
  program_.version.kind == isa::ShaderKind::vertex
      ? record_vertex(registers, vertex::VertexProgram(program_, arithmetic, reciprocal_bits))
      : record_fragment(registers);
  for (const isa::Definition& definition : program_.definitions)
    constants_[definition.index] = definition.values;
  if (program_.version.kind == isa::ShaderKind::pixel) {  // within the ranges of the hardware
    for (Vec4& constant : constants_)
      for (float& value : constant) value = pixel::in_range(value, -1, 1);
    for (Vec4& input : inputs_)
      for (float& value : input) value = pixel::in_range(value, 0, 1);
  }
  for (const isa::Instruction& instruction : program_.instructions) {
    const isa::OpcodeInfo* info = isa::find_opcode(program_.version, instruction.opcode);
    const std::string name = register_name(instruction.destination.file, instruction.destination.index);
    if (info->has_destination && history_.contains(name)) written_.insert(name);
  }
}

void ShaderDebugger::record_vertex(const ShaderCase& registers, const vertex::VertexProgram& program) {
  const auto in = registers.vertex_inputs();
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c) inputs_[i][c] = in->v[i][c][0];
  for (const vertex::VertexState& state : program.trace(constants_, *in)) {
    for (std::size_t i = 0; i < state.temporaries.size(); ++i)
      history_[fmt::format("r{}", i)].push_back(state.temporaries[i]);
    for (int i = 0; i < vertex::kOutputs; ++i)
      history_[output_name(i)].push_back(state.outputs[static_cast<std::size_t>(i)]);
    history_["a0"].push_back({static_cast<float>(state.address), 0, 0, 0});
  }
}

void ShaderDebugger::record_fragment(const ShaderCase& registers) {
  const auto batch = registers.fragment();
  for (std::size_t c = 0; c < 4; ++c) {
    inputs_[0][c] = batch->v0[c][0];
    inputs_[1][c] = batch->v1[c][0];
  }
  bump_ = registers.bump();
  const pixel::PixelProgram program(program_);
  for (const pixel::FragmentState& state : program.trace(constants_, *batch, registers.textures(), bump_)) {
    for (std::size_t i = 0; i < state.temporaries.size(); ++i)
      history_[fmt::format("r{}", i)].push_back(state.temporaries[i]);
    for (std::size_t i = 0; i < state.textures.size(); ++i)
      history_[fmt::format("t{}", i)].push_back(state.textures[i]);
    history_[kDepth].push_back({state.depth, 0, 0, 0});
  }
  if (program.writes_depth()) written_.insert(kDepth);
}

const std::vector<Vec4>* ShaderDebugger::find(const std::string& name) const {
  const auto found = history_.find(name);
  return found == history_.end() ? nullptr : &found->second;
}

std::string ShaderDebugger::source_text(const isa::Source& source) const {
  std::size_t index = source.index;
  if (source.relative) {
    const auto* address = find("a0");
    const long relative = static_cast<long>(index) + (address ? static_cast<long>((*address)[at_][0]) : 0);
    if (relative < 0 || relative >= static_cast<long>(constants_.size()))
      return "c[out of range] = " + text_of({});
    index = static_cast<std::size_t>(relative);
  }
  const std::string name = register_name(source.file, static_cast<int>(index));
  if (source.file == isa::RegisterFile::constant)
    return fmt::format("{} = {}", name, text_of(constants_[index]));
  if (source.file == isa::RegisterFile::input) return fmt::format("{} = {}", name, text_of(inputs_[index]));
  const auto* values = find(name);
  return values ? fmt::format("{} = {}", name, text_of((*values)[at_])) : name;
}

// The rows of a matrix are registers of their own; that of a bump instruction is a state of its stage.
std::vector<std::string> ShaderDebugger::sources(const isa::Instruction& instruction) const {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < instruction.source_count; ++i) {
    isa::Source source = instruction.sources[i];
    const int rows = i == 1 ? std::max(1, isa::matrix_shape(instruction.opcode).rows) : 1;
    for (int row = 0; row < rows; ++row, ++source.index) {
      const std::string text = source_text(source);
      if (std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
    }
  }
  if (bumps(instruction.opcode)) {
    const int stage = instruction.destination.index;
    const auto& [matrix, scale, offset] = bump_[static_cast<std::size_t>(stage)];
    texts.push_back(fmt::format("bump matrix of stage {} = {}", stage,
                                text_of({matrix[0][0], matrix[0][1], matrix[1][0], matrix[1][1]})));
    if (instruction.opcode == isa::Opcode::texbeml)
      texts.push_back(
          fmt::format("luminance scale {:.7g} and offset {:.7g} of stage {}", scale, offset, stage));
  }
  return texts;
}

std::string ShaderDebugger::effect(const isa::Instruction& instruction, std::size_t after) const {
  const std::string name = register_name(instruction.destination.file, instruction.destination.index);
  const auto* values = find(name);
  if (values == nullptr || !isa::find_opcode(program_.version, instruction.opcode)->has_destination)
    return {};
  const Vec4& before = (*values)[at_];
  std::string read = fmt::format("        reads {} = {}\n", name, text_of(before));
  switch (instruction.opcode) {
    case isa::Opcode::texkill: {
      const bool kills = before[0] < 0 || before[1] < 0 || before[2] < 0;
      return fmt::format("{}        {}\n", read, kills ? "cancels the fragment" : "keeps the fragment");
    }
    case isa::Opcode::texdepth:
    case isa::Opcode::texm3x2depth:
      return fmt::format("{}        {} = {}\n", read, kDepth, text_of((*find(kDepth))[after]));
    case isa::Opcode::texm3x2pad:
    case isa::Opcode::texm3x3pad:  // a row of the product that a later instruction takes up
      return read;
    default:
      return fmt::format("        {} before = {}\n        {} after  = {}\n", name, text_of(before), name,
                         text_of((*values)[after]));
  }
}

// One instruction, or a co-issued pair.
void ShaderDebugger::step(std::ostream& out) {
  std::size_t end = at_ + 1;
  while (end < program_.instructions.size() && program_.instructions[end].coissue) ++end;
  for (std::size_t place = at_; place < end; ++place) {
    const isa::Instruction& instruction = program_.instructions[place];
    out << fmt::format("{:>4}  {}\n", instruction.line, isa::disassemble(program_, instruction));
    for (const std::string& source : sources(instruction)) out << "        reads " << source << '\n';
    out << effect(instruction, end);
  }
  from_ = std::exchange(at_, end);
  if (at_end()) out << "end of the program\n";
}

void ShaderDebugger::step_back() {
  --at_;
  while (at_ > 0 && program_.instructions[at_].coissue) --at_;
}

void ShaderDebugger::run_while(std::ostream& out, const std::function<bool()>& go_on) {
  while (!at_end() && go_on()) step(out);
}

// In the last step.
bool ShaderDebugger::watched_changed() const {
  return std::ranges::any_of(watched_, [&](const std::string& name) {
    const auto* values = find(name);
    return !same_bits((*values)[from_], (*values)[at_]);
  });
}

void ShaderDebugger::print(const std::vector<std::string>& names, std::ostream& out) const {
  for (const std::string& name : written_)
    if (names.empty() || std::ranges::count(names, name) > 0)
      out << fmt::format("{} = {}\n", name, text_of((*find(name))[at_]));
}

void ShaderDebugger::list(std::ostream& out) const {
  for (std::size_t i = 0; i < program_.instructions.size(); ++i)
    out << fmt::format("{}{:>4}  {}\n", i == at_ ? '>' : ' ', program_.instructions[i].line,
                       isa::disassemble(program_, program_.instructions[i]));
}

bool ShaderDebugger::obey(std::string_view command, const std::vector<std::string>& arguments,
                          std::ostream& out) {
  const auto is = [&](std::string_view name) {
    return command == name || (command.size() == 1 && command[0] == name[0]);
  };
  const auto check_names = [&] {
    for (const std::string& name : arguments)
      if (!written_.contains(name))
        throw std::invalid_argument(
            fmt::format("the program writes no {}, expected {}", name, fmt::join(written_, ", ")));
  };
  if (is("step")) {
    int left = arguments.empty() ? 1 : number_of(arguments[0]);
    run_while(out, [&] { return left-- > 0; });
  } else if (is("back")) {
    for (int left = arguments.empty() ? 1 : number_of(arguments[0]); left > 0 && at_ > 0; --left) step_back();
  } else if (is("run")) {
    if (arguments.empty()) throw std::invalid_argument("run where? expected a line");
    const int line = number_of(arguments[0]);
    run_while(out, [&] { return program_.instructions[at_].line < line; });
  } else if (is("continue")) {
    if (!at_end()) step(out);
    run_while(out, [&] { return !watched_changed(); });
  } else if (is("watch")) {
    if (arguments.empty()) throw std::invalid_argument("watch what? expected registers");
    check_names();
    watched_.insert(watched_.end(), arguments.begin(), arguments.end());
  } else if (is("unwatch")) {
    for (const std::string& name : arguments) std::erase(watched_, name);
  } else if (is("print")) {
    check_names();
    print(arguments, out);
  } else if (is("list")) {
    list(out);
  } else if (command == "restart") {
    at_ = 0;
  } else if (is("help")) {
    out << kHelp;
  } else if (is("quit")) {
    return false;
  } else {
    throw std::invalid_argument(
        fmt::format("'{}' is no command, expected step, back, run, continue, watch, unwatch, "
                    "print, list, restart, help or quit",
                    command));
  }
  return true;
}

void ShaderDebugger::run(std::istream& commands, std::string_view name, std::ostream& out, bool interactive) {
  const auto prompt = [&] {
    if (interactive)
      out << (at_end() ? std::string("end") : std::to_string(program_.instructions[at_].line)) << "> "
          << std::flush;
  };
  int number = 0;
  prompt();
  for (std::string line; std::getline(commands, line); prompt()) {
    ++number;
    std::istringstream words(line);
    std::string command;
    if (!(words >> command)) continue;
    const std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
    try {
      if (!obey(command, arguments, out)) return;
    } catch (const std::invalid_argument& error) {
      if (!interactive) throw UserError(name, number, error.what());
      out << error.what() << '\n';
    }
  }
  stop_if_asked();  // the signal has ended the wait for a command
}

}  // namespace splatscope::studies
