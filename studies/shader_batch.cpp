#include "studies/shader_batch.h"

#include <fmt/format.h>

#include <bit>
#include <istream>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <utility>

#include "model/error.h"
#include "model/isa/register_names.h"
#include "model/pixel/pixel_program.h"
#include "model/stop.h"
#include "model/vertex/vertex_program.h"
#include "studies/json_text.h"
#include "studies/shader_case.h"

namespace splatscope::studies {
namespace {

using nlohmann::ordered_json;

// Names in the places of errors: of the program in the case, and of the case itself.
constexpr std::string_view kProgramName = "program", kCaseName = "case";

constexpr std::size_t kLongestLine = std::size_t{16} << 20;  // bytes

ordered_json run_vertex(const ShaderCase& test, const isa::Program& program, Arithmetic arithmetic) {
  const auto in = test.vertex_inputs();
  const auto out = std::make_unique<vertex::OutputBatch>();
  vertex::VertexProgram(program, arithmetic).run(test.constants(), *in, *out, 1);
  ordered_json outputs;
  for (const isa::Instruction& instruction : program.instructions) {
    const isa::Destination& destination = instruction.destination;
    const auto place = vertex::output_of(destination.file, destination.index);
    if (!place || instruction.opcode == isa::Opcode::nop) continue;
    const auto& o = out->o[*place];
    outputs[isa::register_name(destination.file, destination.index)] =
        hex_of({o[0][0], o[1][0], o[2][0], o[3][0]});
  }
  return outputs;
}

ordered_json run_pixel(const ShaderCase& test, const isa::Program& program) {
  const auto batch = test.fragment();
  const pixel::PixelProgram runnable(program);
  runnable.run(test.constants(), *batch, 1, test.textures(), test.bump());
  ordered_json outputs;
  outputs["r0"] = hex_of({batch->r0[0][0], batch->r0[1][0], batch->r0[2][0], batch->r0[3][0]});
  if (runnable.writes_depth())
    outputs["depth"] = {fmt::format("{:08x}", std::bit_cast<std::uint32_t>(batch->depth[0]))};
  if (batch->killed.any()) outputs["killed"] = true;
  return outputs;
}

// "2: column 5: rule" of "program:2:5: rule"; "0: what" of "case: what".
std::string place_and_rule(const UserError& error) {
  const std::string_view text = error.what();
  if (!text.starts_with(fmt::format("{}:", kProgramName)))
    return fmt::format("0{}", text.substr(kCaseName.size()));
  const std::string_view place = text.substr(kProgramName.size() + 1);
  const std::size_t column = place.find(':'), rule = place.find(':', column + 1);
  return fmt::format("{}: column {}:{}", place.substr(0, column), place.substr(column + 1, rule - column - 1),
                     place.substr(rule + 1));
}

// One line, without its end. Of a longer line than kLongestLine, one byte more than that and the rest is
// dropped. False at the end of the text.
bool read_line(std::istream& in, std::string& text) {
  text.clear();
  for (char byte; in.get(byte);) {
    if (byte == '\n') return true;
    if (text.size() <= kLongestLine) text.push_back(byte);
  }
  return !text.empty();
}

ordered_json outputs_of(const ShaderCase& test, Arithmetic arithmetic) {
  const isa::Program program = test.program(kProgramName);
  const bool is_vertex = program.version.kind == isa::ShaderKind::vertex;
  return is_vertex ? run_vertex(test, program, arithmetic) : run_pixel(test, program);
}

}  // namespace

ShaderResult run_shader_case(std::string_view text, Arithmetic arithmetic) {
  ordered_json result{{"id", nullptr}};
  bool is_object = true;
  try {
    if (text.size() > kLongestLine)
      throw NoCase(kCaseName, 0, fmt::format("a line is longer than {} bytes", kLongestLine));
    ordered_json object = parse_case(text, kCaseName, 0);
    if (object.contains("id") && is_case_id(object["id"])) result["id"] = object["id"];
    result["outputs"] = outputs_of(ShaderCase::of_object(std::move(object), kCaseName, 0), arithmetic);
  } catch (const UserError& error) {
    is_object = dynamic_cast<const NoCase*>(&error) == nullptr;
    result["error"] = place_and_rule(error);
  }
  return {json_text(result), is_object};  // a message may quote half a character
}

void run_shader_batch(std::istream& cases, std::string_view file, Arithmetic arithmetic,
                      std::ostream& results) {
  int line = 0, first_wrong = 0, wrong = 0;
  for (std::string text; read_line(cases, text);) {
    ++line;
    stop_if_asked();
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    const ShaderResult result = run_shader_case(text, arithmetic);
    results << result.json << '\n';
    if (!result.is_object && wrong++ == 0) first_wrong = line;
  }
  stop_if_asked();
  if (cases.bad()) throw UserError(file, line + 1, "cannot be read, expected a JSON object a line");
  if (wrong == 0) return;
  throw UserError(file, first_wrong,
                  fmt::format("this is no case, expected a JSON object (lines like it: {})", wrong));
}

}  // namespace splatscope::studies
