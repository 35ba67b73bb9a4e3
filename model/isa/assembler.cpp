#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

#include "model/isa/lexer.h"
#include "model/isa/opcode.h"
#include "model/isa/program.h"
#include "model/isa/register_names.h"
#include "model/isa/validate.h"

namespace splatscope::isa {
namespace {

// Position of a component letter in xyzw or rgba, or -1.
int component_of(char letter) {
  const auto in = [&](std::string_view set) { return set.find(letter); };
  if (const auto i = in("xyzw"); i != std::string_view::npos) return static_cast<int>(i);
  if (const auto i = in("rgba"); i != std::string_view::npos) return static_cast<int>(i);
  return -1;
}

bool one_alphabet(std::string_view letters) {
  return letters.find_first_not_of("xyzw") == std::string_view::npos ||
         letters.find_first_not_of("rgba") == std::string_view::npos;
}

// One program's text, from its version to its end.
class Parser {
 public:
  Parser(std::string_view text, std::string_view name) : lexer_(text, name) { program_.name = name; }

  Program parse() {
    lexer_.skip_blank_lines();
    parse_version();
    for (expect_line_end(); !lexer_.at_end(); expect_line_end()) parse_statement();
    return std::move(program_);
  }

 private:
  using Place = Lexer::Place;

  void parse_version() {
    const Place where = here();
    std::string word = lexer_.version_word();
    std::ranges::replace(word, '.', '_');
    const bool vertex = word == "vs_1_1";
    const bool pixel = word.size() == 6 && word.starts_with("ps_1_") && word[5] >= '1' && word[5] <= '4';
    if (!vertex && !pixel)
      lexer_.fail(where, is_not(word, "a version") + ", expected vs_1_1 or ps_1_1 to ps_1_4 first");
    program_.version = {vertex ? ShaderKind::vertex : ShaderKind::pixel, 1, word[5] - '0'};
  }

  // Between statements: the end of a line, or the '+' of the next one.
  void expect_line_end() {
    lexer_.skip_blanks();
    if (!lexer_.at_line_end() && lexer_.peek() != '+') fail_expecting("the end of the line");
    lexer_.skip_blank_lines();
  }

  void parse_statement() {
    const bool coissue = lexer_.accept('+');
    if (coissue) lexer_.skip_blank_lines();
    const Place where = here();
    const std::string word = lexer_.word();
    if (word.empty()) fail_expecting("an instruction");
    if (word == "def" && !coissue) return parse_definition(where);
    if ((word == "dcl" || word.starts_with("dcl_")) && !coissue) return parse_declaration(where, word);
    parse_instruction(where, word, coissue);
  }

  void parse_definition(Place where) {
    Definition definition;
    definition.line = where.line;
    definition.column = where.column;
    definition.before = program_.instructions.size();
    const Place at = here();
    const auto name = parse_register(program_.version.kind, lexer_.word());
    if (!name || name->file != RegisterFile::constant) lexer_.fail(at, "def defines a constant, expected c#");
    definition.index = static_cast<std::uint16_t>(name->index);
    for (float& value : definition.values) {
      expect_comma();
      const auto number = lexer_.number();
      if (!number) fail_expecting("a number of 32 bits");
      value = *number;
    }
    program_.definitions.push_back(definition);
  }

  void parse_declaration(Place where, std::string_view word) {
    if (program_.version.kind != ShaderKind::vertex) lexer_.fail(where, "dcl is of vertex programs");
    std::string_view usage = word.substr(std::min<std::size_t>(word.size(), 4));
    const std::size_t letters = std::min(usage.find_first_of("0123456789"), usage.size());
    const std::string_view digits = usage.substr(letters);
    usage = usage.substr(0, letters);
    Declaration declaration;
    declaration.line = where.line;
    declaration.column = where.column;
    declaration.before = program_.instructions.size();
    int number = 0, index = 0;
    while (number < kUsages && usage_name(number) != usage) ++number;
    const char* const end = digits.data() + digits.size();
    if (number == kUsages || digits.size() > 2 || std::from_chars(digits.data(), end, index).ptr != end ||
        index > kMostUsageIndex)
      lexer_.fail(where,
                  fmt::format("'{}' is not a declaration, expected dcl_position, dcl_normal0, ...", word));
    declaration.usage = static_cast<std::uint8_t>(number);
    declaration.usage_index = static_cast<std::uint8_t>(index);
    const Place at = here();
    declaration.destination = parse_destination();
    if (declaration.destination.file != RegisterFile::input)
      lexer_.fail(at, "dcl declares an input, expected v#");
    program_.declarations.push_back(declaration);
  }

  void parse_instruction(Place where, const std::string& word, bool coissue) {
    Instruction instruction;
    instruction.line = where.line;
    instruction.column = where.column;
    instruction.coissue = coissue;
    const OpcodeInfo& info = parse_mnemonic(where, word, instruction.destination);
    instruction.opcode = info.opcode;
    instruction.source_count = info.source_count;
    if (info.has_destination) {
      const Destination modifiers = instruction.destination;
      instruction.destination = parse_destination();
      instruction.destination.shift = modifiers.shift;
      instruction.destination.saturate = modifiers.saturate;
    }
    for (std::size_t i = 0; i < info.source_count; ++i) {
      if (i > 0 || info.has_destination) expect_comma();
      instruction.sources[i] = parse_source();
    }
    program_.instructions.push_back(instruction);
  }

  // "mul_x2_sat": the instruction's row, and its destination modifiers into `modifiers`.
  const OpcodeInfo& parse_mnemonic(Place where, std::string_view word, Destination& modifiers) {
    const std::string_view base = word.substr(0, word.find('_'));
    const OpcodeInfo* info = find_opcode(program_.version, base);
    if (info == nullptr) {
      const bool elsewhere =
          std::ranges::any_of(opcode_table(), [&](const OpcodeInfo& row) { return row.name == base; });
      lexer_.fail(where,
                  fmt::format("{} '{}'{}",
                              elsewhere ? to_string(program_.version) + " has no" : "unknown instruction",
                              base, elsewhere ? "" : fmt::format(" in {}", to_string(program_.version))));
    }
    for (std::string_view rest = word.substr(base.size()); !rest.empty();) {
      const std::size_t end = std::min(rest.find('_', 1), rest.size());
      const std::string_view suffix = rest.substr(1, end - 1);
      rest.remove_prefix(end);
      apply_suffix(where, suffix, modifiers);
    }
    return *info;
  }

  void apply_suffix(Place where, std::string_view suffix, Destination& modifiers) {
    constexpr std::pair<std::string_view, int> kShifts[] = {{"x2", 1},  {"x4", 2},  {"x8", 3},
                                                            {"d2", -1}, {"d4", -2}, {"d8", -3}};
    if (suffix == "sat" && !modifiers.saturate) {
      modifiers.saturate = true;
      return;
    }
    const auto shift = std::ranges::find(kShifts, suffix, &std::pair<std::string_view, int>::first);
    if (shift == std::end(kShifts) || modifiers.shift != 0 || modifiers.saturate)
      lexer_.fail(
          where,
          fmt::format("'_{}' is not a modifier here, expected one of _x2 _x4 _x8 _d2 _d4 _d8, then _sat",
                      suffix));
    modifiers.shift = static_cast<std::int8_t>(shift->second);
  }

  Destination parse_destination() {
    const Place where = here();
    const std::string word = lexer_.word();
    const auto name = parse_register(program_.version.kind, word);
    if (!name) fail_for_register(where, word);
    if (lexer_.peek() == '[') lexer_.fail(where, "a destination cannot be indexed, only a source c#");
    Destination destination;
    destination.file = name->file;
    destination.index = static_cast<std::uint16_t>(name->index);
    if (lexer_.accept('.')) {
      const Place at = here();
      const std::string letters = lexer_.word();
      destination.mask = 0;
      for (int previous = -1; const char letter : letters) {
        const int component = component_of(letter);
        if (component <= previous || !one_alphabet(letters)) lexer_.fail(at, mask_message(letters));
        destination.mask = static_cast<std::uint8_t>(destination.mask | (1 << component));
        previous = component;
      }
      if (letters.empty()) lexer_.fail(at, mask_message(letters));
    }
    return destination;
  }

  static std::string mask_message(std::string_view letters) {
    return fmt::format("'.{}' is not a write mask, expected letters of xyzw or rgba in that order", letters);
  }

  Source parse_source() {
    Source source;
    if (lexer_.accept('-')) source.negate = true;
    lexer_.skip_blanks();
    const Place where = here();
    std::string word = lexer_.word();
    if (word == "1" && program_.version.kind == ShaderKind::pixel && !source.negate) {
      if (!lexer_.accept('-')) fail_expecting("'-' and a register behind the 1");
      source.modifier = SourceModifier::invert;
      lexer_.skip_blanks();
      word = lexer_.word();
    }
    const std::size_t underscore = std::min(word.find('_'), word.size());
    parse_source_register(where, word.substr(0, underscore), source);
    if (underscore < word.size()) apply_source_modifier(where, word.substr(underscore + 1), source);
    if (lexer_.peek() == '_') apply_source_modifier(where, lexer_.word().substr(1), source);
    if (lexer_.accept('.')) source.swizzle = parse_swizzle();
    return source;
  }

  void parse_source_register(Place where, const std::string& word, Source& source) {
    if (lexer_.accept('[')) {
      const bool numbered = word.size() > 1;
      const auto base = parse_register(program_.version.kind, numbered ? word : word + "0");
      if (!base || base->file != RegisterFile::constant)
        lexer_.fail(where, fmt::format("'{}' cannot be indexed, only c[...]", word));
      return parse_indexed_constant(base->index, source);
    }
    const auto name = parse_register(program_.version.kind, word);
    if (!name) fail_for_register(where, word);
    source.file = name->file;
    source.index = static_cast<std::uint16_t>(name->index);
  }

  // c[a0.x], c[a0.x + 3], c1[2 + a0.x + 3], c[3] and so on, after the bracket: the sum of all numbers, as
  // D3DX reads them.
  void parse_indexed_constant(int index, Source& source) {
    source.file = RegisterFile::constant;
    do {
      const Place at = here();
      const std::string word = lexer_.word();
      if (word == "a0" && !source.relative && program_.version.kind == ShaderKind::vertex) {
        const bool x = lexer_.accept('.') && lexer_.word() == "x";
        if (!x) lexer_.fail(at, "the address register has one component, expected a0.x");
        source.relative = true;
      } else {
        const auto number = parse_register(ShaderKind::vertex, "c" + word);
        if (!number) lexer_.fail(at, is_not(word, "an index") + ", expected c[a0.x + number]");
        index += number->index;
        if (index > kMaximumIndex)
          lexer_.fail(at, fmt::format("c{} does not exist, expected c{} at most", index, kMaximumIndex));
      }
    } while (lexer_.accept('+'));
    source.index = static_cast<std::uint16_t>(index);
    if (!lexer_.accept(']')) fail_expecting("']'");
  }

  void apply_source_modifier(Place where, std::string_view suffix, Source& source) {
    using enum SourceModifier;
    constexpr std::pair<std::string_view, SourceModifier> kModifiers[] = {
        {"bias", bias}, {"bx2", bx2}, {"x2", x2}, {"dz", dz}, {"db", dz}, {"dw", dw}, {"da", dw}};
    const auto found =
        std::ranges::find(kModifiers, suffix, &std::pair<std::string_view, SourceModifier>::first);
    if (program_.version.kind != ShaderKind::pixel || found == std::end(kModifiers))
      lexer_.fail(where,
                  fmt::format("'_{}' is not a source modifier here, expected one of _bias _bx2 _x2 _dz _dw "
                              "in a pixel program",
                              suffix));
    if (source.modifier != none)
      lexer_.fail(where,
                  fmt::format("'_{}' beside another modifier of the source, expected one alone", suffix));
    const bool divides = found->second == dz || found->second == dw;
    if (divides && source.negate)
      lexer_.fail(where, fmt::format("'_{}' cannot be combined with negation", suffix));
    source.modifier = found->second;
  }

  std::array<std::uint8_t, 4> parse_swizzle() {
    const Place where = here();
    const std::string letters = lexer_.word();
    if (letters.empty() || letters.size() > 4 || !one_alphabet(letters))
      lexer_.fail(where,
                  fmt::format("'.{}' is not a swizzle, expected 1 to 4 letters of xyzw or rgba", letters));
    std::array<std::uint8_t, 4> swizzle{};
    for (std::size_t i = 0; i < 4; ++i)
      swizzle[i] = static_cast<std::uint8_t>(component_of(letters[std::min(i, letters.size() - 1)]));
    return swizzle;
  }

  void expect_comma() {
    if (!lexer_.accept(',')) fail_expecting("',' and another operand");
  }

  [[noreturn]] void fail_expecting(std::string_view expected) {
    const Place where = here();
    lexer_.fail(where, fmt::format("{}, expected {}", lexer_.found(), expected));
  }
  // "'word' is not a register"
  std::string is_not(std::string_view word, std::string_view what) {
    return word.empty() ? lexer_.found() : fmt::format("'{}' is not {}", word, what);
  }
  [[noreturn]] void fail_for_register(Place where, std::string_view word) {
    const std::string expected = fmt::format("a register of {}", to_string(program_.version));
    if (word.empty()) fail_expecting(expected);
    lexer_.fail(where, is_not(word, expected));
  }

  Place here() {
    lexer_.skip_blanks();
    return lexer_.place();
  }

  Lexer lexer_;
  Program program_;
};

}  // namespace

Program assemble(std::string_view text, std::string_view name) {
  return Parser(text, name).parse();
}

Program load(std::string_view text, std::string_view name) {
  Program program = assemble(text, name);
  validate(program);
  return program;
}

}  // namespace splatscope::isa
