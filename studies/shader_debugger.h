#pragma once

#include <array>
#include <functional>
#include <iosfwd>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "model/number/formats.h"
#include "studies/shader_case.h"

// Steps one vertex or one fragment through a program: `splatscope shader debug`.
namespace splatscope::studies {

// A program has no branches, so the debugger runs it once and then moves through the recorded states, back as
// well as forward.
class ShaderDebugger {
 public:
  // `reciprocal_bits` as of a machine's numbers.
  ShaderDebugger(isa::Program program, const ShaderCase& registers, Arithmetic arithmetic,
                 int reciprocal_bits = 24);

  // Obeys commands, one a line, until "quit" or their end; "help" lists them. Interactive: prompts, and says
  // what is wrong with a command and goes on; else a wrong command is a UserError at `name`:line.
  void run(std::istream& commands, std::string_view name, std::ostream& out, bool interactive);

 private:
  // Registers by name; one value before the first instruction and one after each.
  using History = std::map<std::string, std::vector<Vec4>>;

  void record_vertex(const ShaderCase& registers, const vertex::VertexProgram& program);
  void record_fragment(const ShaderCase& registers);

  // False where the command is quit. Throws std::invalid_argument saying what is wrong with it.
  bool obey(std::string_view command, const std::vector<std::string>& arguments, std::ostream& out);
  void step(std::ostream& out);
  void step_back();  // as far as step() goes
  void run_while(std::ostream& out, const std::function<bool()>& go_on);
  void print(const std::vector<std::string>& names, std::ostream& out) const;
  void list(std::ostream& out) const;
  bool watched_changed() const;
  bool at_end() const { return at_ == program_.instructions.size(); }
  // What an instruction reads, one text a register.
  std::vector<std::string> sources(const isa::Instruction& instruction) const;
  // What the destination was, and what the instruction makes of it; `after`: instructions done with it.
  std::string effect(const isa::Instruction& instruction, std::size_t after) const;
  std::string source_text(const isa::Source& source) const;
  const std::vector<Vec4>* find(const std::string& name) const;

  isa::Program program_;
  std::vector<Vec4> constants_;
  std::array<Vec4, 16> inputs_{};
  pixel::BumpStages bump_{};
  History history_;
  std::set<std::string> written_;  // by the program: what can be printed and watched
  std::vector<std::string> watched_;
  std::size_t at_ = 0;    // instructions done
  std::size_t from_ = 0;  // and before the last step: a pair is one
};

}  // namespace splatscope::studies
