#pragma once

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "model/error.h"
#include "model/isa/program.h"
#include "model/pixel/pixel_program.h"
#include "model/vertex/vertex_program.h"

// Registers that a user gives a program, as JSON (docs/shaders.md, Batches).
namespace splatscope::studies {

// Text that is no JSON object, or one too long or too deep to look into.
class NoCase : public UserError {
 public:
  using UserError::UserError;
};

// Text to a JSON object, which may still be no case. Throws NoCase at `file`:`line` where it is none, or is
// nested deeper than any case; UserError where a key stands twice.
nlohmann::ordered_json parse_case(std::string_view text, std::string_view file, int line);

// Whether the "id" of a case is text or a number, as it has to be.
bool is_case_id(const nlohmann::ordered_json& id);

// A value as a case gives it: the binary32 bits of each component in hex.
nlohmann::ordered_json hex_of(const Vec4& value);

// One case. Values are binary32 bits in hex; what is not given is 0 (vertex inputs: 0, 0, 0, 1).
class ShaderCase {
 public:
  // Throws UserError at `file`:`line` where the text is no case.
  ShaderCase(std::string_view text, std::string_view file, int line);
  // The same, of an object already parsed.
  static ShaderCase of_object(nlohmann::ordered_json object, std::string_view file, int line);

  // The program in the case, validated. Its own errors are UserErrors of `name`.
  isa::Program program(std::string_view name) const;

  std::vector<Vec4> constants() const;
  std::unique_ptr<vertex::InputBatch> vertex_inputs() const;  // in every lane
  std::unique_ptr<pixel::FragmentBatch> fragment() const;     // in lane 0
  pixel::Sampler textures() const;                            // constant 1x1 textures, for lane 0
  pixel::BumpStages bump() const;

 private:
  ShaderCase(std::string_view file, int line, nlohmann::ordered_json object);
  [[noreturn]] void fail(std::string_view message) const;
  std::uint32_t word_of(std::string_view what, const nlohmann::ordered_json& hex) const;
  template <std::size_t words>
  std::array<float, words> vector_of(std::string_view name, const nlohmann::ordered_json& hex) const;

  // Calls set(index, value) for the registers of a group ("constants": c0, c1, ...), whose indices are below
  // `count`.
  template <std::size_t words = 4, typename Set>
  void registers(std::string_view group, char letter, int count, Set set) const;

  nlohmann::ordered_json case_;
  std::string file_;
  int line_;
};

}  // namespace splatscope::studies
