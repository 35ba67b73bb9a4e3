#include "model/isa/lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "model/error.h"

namespace splatscope::isa {
namespace {

constexpr std::size_t kLongestShown = 32;  // of a word in a message

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}
bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

}  // namespace

Lexer::Lexer(std::string_view text, std::string_view name) : name_(name), text_(text) {
  enum class In { code, line_comment, block_comment } in = In::code;
  int line = 1, column = 1;
  Place opened{1, 1};
  for (std::size_t i = 0; i < text_.size(); ++i, ++column) {
    char& c = text_[i];
    const char next = i + 1 < text_.size() ? text_[i + 1] : '\0';
    if (c == '\n') {
      if (in == In::line_comment) in = In::code;
      ++line;
      column = 0;
      continue;
    }
    switch (in) {
      case In::code:
        if (c == '#') expect_no_directive(std::string_view(text_).substr(i + 1), {line, column});
        if (c == ';' || c == '#' || (c == '/' && next == '/')) {
          in = In::line_comment;
          c = ' ';
        } else if (c == '/' && next == '*') {
          in = In::block_comment;
          opened = {line, column};
          text_[i] = text_[i + 1] = ' ';
          ++i, ++column;
        } else {
          c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        }
        break;
      case In::line_comment:
        c = ' ';
        break;
      case In::block_comment:
        if (c == '*' && next == '/') {
          in = In::code;
          text_[i + 1] = ' ';
          c = ' ';
          ++i, ++column;
        } else {
          c = ' ';
        }
        break;
    }
  }
  if (in == In::block_comment) fail(opened, "this comment does not end, expected */");
}

// `after` a '#'. D3DX runs a preprocessor; what it would leave out must not count as a comment.
void Lexer::expect_no_directive(std::string_view after, Place where) const {
  after.remove_prefix(std::min(after.find_first_not_of(" \t"), after.size()));
  const auto* const end = std::ranges::find_if_not(after, is_word);
  const std::string_view word(after.begin(), end);
  constexpr std::string_view kDirectives[] = {"define", "undef", "include", "if",   "ifdef",
                                              "ifndef", "elif",  "else",    "endif"};
  if (std::ranges::count(kDirectives, word) != 0)
    fail(where, "'#" + std::string(word) + "' needs a preprocessor, expected its output");
}

void Lexer::advance() {
  if (text_[position_] == '\n') {
    ++line_;
    column_ = 0;
  }
  ++position_;
  ++column_;
}

void Lexer::skip_blanks() {
  while (!at_end() && is_blank(text_[position_])) advance();
}

void Lexer::skip_blank_lines() {
  while (!at_end() && (is_blank(text_[position_]) || text_[position_] == '\n')) advance();
}

bool Lexer::accept(char wanted) {
  skip_blanks();
  if (peek() != wanted || at_end()) return false;
  advance();
  return true;
}

std::string Lexer::word() {
  skip_blanks();
  std::string result;
  for (; !at_end() && is_word(text_[position_]); advance()) result += text_[position_];
  return result;
}

std::string Lexer::version_word() {
  skip_blanks();
  std::string result;
  for (; !at_end() && (is_word(text_[position_]) || text_[position_] == '.'); advance())
    result += text_[position_];
  return result;
}

std::string Lexer::found() const {
  if (at_line_end()) return "the line ends here";
  if (const auto byte = static_cast<unsigned char>(peek()); byte <= ' ' || byte > '~')
    return fmt::format("the byte 0x{:02x} stands here", byte);
  std::size_t end = position_;
  const auto is_digit = [&](std::size_t at) {
    return at < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at])) != 0;
  };
  const bool number = is_digit(end) || (peek() == '.' && is_digit(end + 1));
  const auto goes_on = [&](std::size_t at) {
    const bool sign = text_[at] == '-' || text_[at] == '+';
    return is_word(text_[at]) || (number && (text_[at] == '.' || (sign && text_[at - 1] == 'e')));
  };
  while (end < text_.size() && goes_on(end)) ++end;
  const std::size_t shown = std::clamp<std::size_t>(end - position_, 1, kLongestShown);
  return fmt::format("'{}' stands here", std::string_view(text_).substr(position_, shown));
}

std::optional<float> Lexer::number() {
  skip_blanks();
  bool negative = false;
  if (peek() == '-' || peek() == '+') {
    negative = peek() == '-';
    advance();
  }
  skip_blanks();
  if (!std::isdigit(static_cast<unsigned char>(peek())) && peek() != '.') return std::nullopt;
  float value = 0;
  const char* begin = text_.data() + position_;
  const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
  if (error == std::errc::result_out_of_range) value = std::strtof(begin, nullptr);  // what is too small is 0
  if (error == std::errc::invalid_argument || !std::isfinite(value)) return std::nullopt;
  for (const char* c = begin; c != end; ++c) advance();
  if (peek() == 'f') advance();
  return negative ? -value : value;
}

void Lexer::fail(Place where, std::string_view message) const {
  throw UserError(name_, where.line, where.column, message);
}

}  // namespace splatscope::isa
