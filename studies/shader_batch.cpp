#include "studies/shader_batch.h"

#include <fmt/format.h>

#include <bit>
#include <istream>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>

#include "model/error.h"
#include "model/isa/register_names.h"
#include "model/pixel/pixel_program.h"
#include "model/vertex/vertex_program.h"
#include "studies/shader_case.h"

namespace splatscope::studies {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kProgramName = "program";

ordered_json hex_of(const Vec4& value) {
  ordered_json hex = ordered_json::array();
  for (const float component : value)
    hex.push_back(fmt::format("{:08x}", std::bit_cast<std::uint32_t>(component)));
  return hex;
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

ordered_json run_vertex(const ShaderCase& test, const isa::Program& program, Arithmetic arithmetic) {
  const auto in = test.vertex_inputs();
  const auto out = std::make_unique<vertex::OutputBatch>();
  vertex::VertexProgram(program, arithmetic).run(test.constants(), *in, *out, 1);
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

ordered_json run_pixel(const ShaderCase& test, const isa::Program& program) {
  const auto batch = test.fragment();
  const pixel::PixelProgram runnable(program);
  runnable.run(test.constants(), *batch, 1, test.textures());
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
  const ShaderCase test(text, file, line);
  ordered_json result{{"id", test.id()}};
  isa::Program program;
  try {
    program = test.program(kProgramName);
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
