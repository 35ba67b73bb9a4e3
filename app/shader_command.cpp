#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

#include "app/commands.h"
#include "model/error.h"
#include "model/input_file.h"
#include "model/isa/program.h"
#include "model/isa/tokens.h"
#include "model/isa/validate.h"
#include "studies/shader_batch.h"
#include "studies/shader_debugger.h"
#include "studies/shader_report.h"
#include "traces/output_files.h"

namespace splatscope::app {
namespace {

struct ShaderOptions {
  std::string file;
  std::string out;
  std::string batch;
  std::string registers;
  bool no_validate = false;
  std::string arithmetic = "ieee";
};
using Options = std::shared_ptr<ShaderOptions>;

isa::Program valid_shader(const std::string& file) {
  isa::Program program = studies::read_shader(file);
  isa::validate(program);
  return program;
}

void assemble(const ShaderOptions& options) {
  traces::expect_apart({{"--out", options.out}}, {{"FILE", options.file}});
  const isa::Program program = studies::read_shader(options.file);
  if (!options.no_validate) isa::validate(program);
  traces::write_file(options.out, isa::bytes_of_tokens(isa::write_tokens(program)));
}

void disassemble(const ShaderOptions& options) {
  if (!options.out.empty()) traces::expect_apart({{"--out", options.out}}, {{"FILE", options.file}});
  const std::string text = isa::disassemble(studies::read_shader(options.file));
  if (options.out.empty())
    std::cout << text;
  else
    traces::write_file(options.out, text);
}

Arithmetic arithmetic_of(const ShaderOptions& options) {
  return options.arithmetic == "ieee" ? Arithmetic::ieee : Arithmetic::nv20;
}

void run_batch(const ShaderOptions& options) {
  std::ifstream cases(options.batch);
  if (!cases || std::filesystem::is_directory(options.batch))
    throw UserError(options.batch, 0, "cannot be read, expected a file of one JSON object a line");
  studies::run_shader_batch(cases, options.batch, arithmetic_of(options), std::cout);
}

// Registers from a file of one JSON object, or none.
studies::ShaderCase registers_of(const std::string& file) {
  if (file.empty()) return {"{}", "no registers", 0};
  return {read_text_file(file, "a JSON object of registers"), file, 1};
}

void debug(const ShaderOptions& options) {
  studies::ShaderDebugger debugger(valid_shader(options.file), registers_of(options.registers),
                                   arithmetic_of(options));
  debugger.run(std::cin, "standard input", std::cout, isatty(STDIN_FILENO) != 0);
}

CLI::App* add_part(CLI::App* shader, const Options& options, const char* name, const char* what,
                   const char* example) {
  CLI::App* part = shader->add_subcommand(name, what);
  part->add_option("FILE", options->file, "program: assembly text, or Direct3D tokens")->required();
  part->footer(example);
  return part;
}

void add_arithmetic(CLI::App* part, const Options& options) {
  part->add_option("--arithmetic", options->arithmetic, "of vertex programs: ieee or nv20")
      ->check([](const std::string& name) -> std::string {
        return name == "ieee" || name == "nv20" ? "" : fmt::format("\"{}\", expected ieee or nv20", name);
      })
      ->capture_default_str();
}

}  // namespace

void add_shader_command(CLI::App& app) {
  const auto options = std::make_shared<ShaderOptions>();
  CLI::App* shader = app.add_subcommand("shader", "vertex and pixel programs: vs_1_1, ps_1_1 to ps_1_4");
  shader->require_subcommand(1);
  shader->footer("Example: splatscope shader check kernels/object_space_ewa/splat_ewa.vs");

  CLI::App* check = add_part(shader, options, "check", "validate, and say what the program costs and wastes",
                             "Example: splatscope shader check kernels/object_space_ewa/splat_ewa.vs");
  check->callback([options] { std::cout << studies::describe_shader(valid_shader(options->file)); });

  CLI::App* count = add_part(shader, options, "count", "the instruction slots",
                             "Example: splatscope shader count kernels/object_space_ewa/splat_ewa.vs");
  count->callback([options] { std::cout << isa::slot_count(valid_shader(options->file)) << '\n'; });

  CLI::App* to_tokens = add_part(shader, options, "assemble", "text to Direct3D tokens, little-endian DWORDs",
                                 "Example: splatscope shader assemble splat.vs -o splat.vso");
  to_tokens->add_option("-o,--out", options->out, "file of tokens")->required();
  to_tokens->add_flag("--no-validate", options->no_validate, "syntax only, for fragments");
  to_tokens->callback([options] { assemble(*options); });

  CLI::App* to_text = add_part(shader, options, "disassemble", "Direct3D tokens to text",
                               "Example: splatscope shader disassemble splat.vso");
  to_text->add_option("-o,--out", options->out, "file of text (else standard output)");
  to_text->callback([options] { disassemble(*options); });

  CLI::App* run = shader->add_subcommand("run", "run programs on given registers");
  run->add_option("--batch", options->batch, "cases, one JSON object a line")->required();
  add_arithmetic(run, options);
  CLI::App* debug_part =
      add_part(shader, options, "debug",
               "step one vertex or fragment through the program; commands from standard input",
               "Example: splatscope shader debug splat.vs --registers case.json < commands.txt");
  debug_part->add_option("--registers", options->registers,
                         "constants, inputs, ... as a case of `run`, without its program");
  add_arithmetic(debug_part, options);
  debug_part->callback([options] { debug(*options); });

  run->footer(
      R"(Each case gives a line: {"id", "outputs"}, or {"id", "error": "LINE: what"} with the
program's line, or 0 where the case itself is wrong; the batch goes on. After a line
that is no JSON object the exit status is 2 at the end.
Example: splatscope shader run --batch cases.jsonl --arithmetic nv20)");
  run->callback([options] { run_batch(*options); });
}

}  // namespace splatscope::app
