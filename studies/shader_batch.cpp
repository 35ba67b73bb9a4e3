#include "studies/shader_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <istream>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/register_names.h"
#include "model/isa/tokens.h"
#include "model/isa/validate.h"
#include "model/pixel/pixel_program.h"
#include "model/vertex/vertex_program.h"

namespace splatscope::studies {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kProgramName = "program";
constexpr int kConstants = 96;

ordered_json hex_of(const Vec4& value) {
  ordered_json hex = ordered_json::array();
  for (const float component : value)
    hex.push_back(fmt::format("{:08x}", std::bit_cast<std::uint32_t>(component)));
  return hex;
}

// One case and where it stands, for messages.
class Case {
 public:
  Case(std::string_view text, std::string_view file, int line) : file_(file), line_(line) {
    case_ = ordered_json::parse(text, nullptr, false);
    if (!case_.is_object()) fail("this is no JSON object, expected a case");
    constexpr std::string_view kKeys[] = {"id",     "program",   "tokens",  "constants",
                                          "inputs", "texcoords", "textures"};
    for (const auto& [key, value] : case_.items())
      if (std::ranges::find(kKeys, key) == std::end(kKeys))
        fail(fmt::format("unknown key \"{}\", expected one of {}", key, fmt::join(kKeys, ", ")));
  }

  ordered_json id() const { return case_.value("id", ordered_json(nullptr)); }

  // Throws UserError of kProgramName where the program does not load.
  isa::Program program() const {
    if (case_.contains("program") == case_.contains("tokens")) fail("expected \"program\" or \"tokens\"");
    if (case_.contains("tokens")) {
      const isa::Program program = isa::read_tokens(tokens(), kProgramName);
      isa::validate(program);
      return program;
    }
    if (!case_["program"].is_string()) fail("\"program\" is no text, expected assembly");
    return isa::load(case_["program"].get<std::string>(), kProgramName);
  }

  // Calls set(index, value) for the registers of a group ("constants": c0, c1, ...) below `count`.
  template <typename Set>
  void registers(std::string_view group, char letter, int count, Set set) const {
    if (!case_.contains(group)) return;
    if (!case_[group].is_object()) fail(fmt::format("\"{}\" is no object", group));
    for (const auto& [name, value] : case_[group].items()) {
      int index = -1;
      const char* end = name.data() + name.size();
      const bool number = name.size() > 1 && std::from_chars(name.data() + 1, end, index).ptr == end;
      if (!number || name[0] != letter || index < 0 || index >= count)
        fail(fmt::format("{} has \"{}\", expected {}0 to {}{}", group, name, letter, letter, count - 1));
      set(static_cast<std::size_t>(index), vector_of(name, value));
    }
  }

 private:
  [[noreturn]] void fail(std::string_view message) const { throw UserError(file_, line_, message); }

  std::uint32_t word_of(std::string_view what, const ordered_json& hex) const {
    std::uint32_t word = 0;
    const std::string text = hex.is_string() ? hex.get<std::string>() : "";
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, word, 16);
    if (text.empty() || stop != end || error != std::errc{})
      fail(fmt::format("{} is {}, expected 32 bits in hex", what, hex.dump()));
    return word;
  }

  std::vector<std::uint32_t> tokens() const {
    std::vector<std::uint32_t> tokens;
    if (!case_["tokens"].is_array()) fail("\"tokens\" is no array, expected DWORDs in hex");
    for (const ordered_json& hex : case_["tokens"]) tokens.push_back(word_of("a token", hex));
    return tokens;
  }

  Vec4 vector_of(std::string_view name, const ordered_json& hex) const {
    if (!hex.is_array() || hex.size() != 4)
      fail(fmt::format("{} is {}, expected four words in hex", name, hex.dump()));
    Vec4 value{};
    for (std::size_t i = 0; i < 4; ++i) value[i] = std::bit_cast<float>(word_of(name, hex[i]));
    return value;
  }

  ordered_json case_;
  std::string file_;
  int line_;
};

std::vector<Vec4> constants_of(const Case& test) {
  std::vector<Vec4> constants(kConstants);
  test.registers("constants", 'c', kConstants,
                 [&](std::size_t i, const Vec4& value) { constants[i] = value; });
  return constants;
}

int output_place(isa::RegisterFile file, int index) {
  switch (file) {
    case isa::RegisterFile::position_out:
      return vertex::oPos;
    case isa::RegisterFile::color_out:
      return vertex::oD0 + index;
    case isa::RegisterFile::texcoord_out:
      return vertex::oT0 + index;
    case isa::RegisterFile::fog_out:
      return vertex::oFog;
    case isa::RegisterFile::point_size_out:
      return vertex::oPts;
    default:
      return -1;
  }
}

ordered_json run_vertex(const Case& test, const isa::Program& program, Arithmetic arithmetic) {
  const auto in = std::make_unique<vertex::InputBatch>();
  const auto out = std::make_unique<vertex::OutputBatch>();
  const auto set_input = [&](std::size_t i, const Vec4& value) {
    for (std::size_t c = 0; c < 4; ++c) std::fill_n(in->v[i][c], vertex::kBatch, value[c]);
  };
  for (std::size_t i = 0; i < 16; ++i) set_input(i, {0, 0, 0, 1});
  test.registers("inputs", 'v', 16, set_input);
  vertex::VertexProgram(program, arithmetic).run(constants_of(test), *in, *out, 1);
  ordered_json outputs;
  for (const isa::Instruction& instruction : program.instructions) {
    const isa::Destination& destination = instruction.destination;
    const int place = output_place(destination.file, destination.index);
    if (place < 0 || instruction.opcode == isa::Opcode::nop) continue;
    const auto& o = out->o[place];
    outputs[isa::register_name(destination.file, destination.index)] =
        hex_of({o[0][0], o[1][0], o[2][0], o[3][0]});
  }
  return outputs;
}

ordered_json run_pixel(const Case& test, const isa::Program& program) {
  const auto batch = std::make_unique<pixel::FragmentBatch>();
  const auto setter = [](auto lanes) {
    return [lanes](std::size_t i, const Vec4& value) {
      for (std::size_t c = 0; c < 4; ++c) lanes(i)[c][0] = value[c];
    };
  };
  test.registers("inputs", 'v', 2, setter([&](std::size_t i) { return i == 0 ? batch->v0 : batch->v1; }));
  test.registers("texcoords", 't', pixel::kStages, setter([&](std::size_t i) { return batch->t[i]; }));
  std::array<Vec4, pixel::kStages> texels{};
  test.registers("textures", 't', pixel::kStages,
                 [&](std::size_t i, const Vec4& value) { texels[i] = value; });
  const pixel::PixelProgram runnable(program);
  runnable.run(constants_of(test), *batch, 1, [&](int stage, const pixel::Lanes*, pixel::Lanes* texel, int) {
    for (std::size_t c = 0; c < 4; ++c) texel[c][0] = texels[static_cast<std::size_t>(stage)][c];
  });
  ordered_json outputs;
  outputs["r0"] = hex_of({batch->r0[0][0], batch->r0[1][0], batch->r0[2][0], batch->r0[3][0]});
  if (runnable.writes_depth())
    outputs["depth"] = {fmt::format("{:08x}", std::bit_cast<std::uint32_t>(batch->depth[0]))};
  if (batch->killed != 0) outputs["killed"] = true;
  return outputs;
}

// "2: column 5: rule" of "program:2:5: rule".
std::string place_and_rule(const UserError& error) {
  const std::string text = std::string(error.what()).substr(kProgramName.size() + 1);
  const std::size_t column = text.find(':'), rule = text.find(':', column + 1);
  return fmt::format("{}: column {}:{}", text.substr(0, column), text.substr(column + 1, rule - column - 1),
                     text.substr(rule + 1));
}

}  // namespace

std::string run_shader_case(std::string_view text, Arithmetic arithmetic, std::string_view file, int line) {
  const Case test(text, file, line);
  ordered_json result{{"id", test.id()}};
  isa::Program program;
  try {
    program = test.program();
  } catch (const UserError& error) {
    if (!std::string_view(error.what()).starts_with(fmt::format("{}:", kProgramName))) throw;
    result["error"] = place_and_rule(error);
    return result.dump();
  }
  const bool is_vertex = program.version.kind == isa::ShaderKind::vertex;
  result["outputs"] = is_vertex ? run_vertex(test, program, arithmetic) : run_pixel(test, program);
  return result.dump();
}

void run_shader_batch(std::istream& cases, std::string_view file, Arithmetic arithmetic,
                      std::ostream& results) {
  int line = 0;
  for (std::string text; std::getline(cases, text);) {
    ++line;
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    results << run_shader_case(text, arithmetic, file, line) << '\n';
  }
}

}  // namespace splatscope::studies
