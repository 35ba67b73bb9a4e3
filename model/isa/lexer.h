#pragma once

#include <optional>
#include <string>
#include <string_view>

// The characters of an assembly text with their places.
namespace splatscope::isa {

// Walks over a text in which comments (// ; # to the end of the line, and between /* and */) are blanks and
// letters are lower case: shader assembly tells no case. Lines and columns are those of the text as given,
// from 1.
class Lexer {
 public:
  // Throws UserError where a comment does not end, or where a '#' asks for a preprocessor.
  Lexer(std::string_view text, std::string_view name);

  struct Place {
    int line;
    int column;
  };
  Place place() const { return {line_, column_}; }

  bool at_end() const { return position_ == text_.size(); }
  bool at_line_end() const { return at_end() || text_[position_] == '\n'; }
  char peek() const { return at_end() ? '\0' : text_[position_]; }
  void skip_blanks();          // within the line
  void skip_blank_lines();     // and over line ends
  bool accept(char wanted);    // blanks, then `wanted`: consumed where it is there
  std::string word();          // letters, digits, '_'; may be empty
  std::string version_word();  // the same and '.'
  std::string found() const;   // for messages: "'word' stands here", "the line ends here"; ASCII

  // A number as `def` takes it: decimal, optional sign, exponent and 'f'. Nothing where there is none or
  // where it does not fit a binary32.
  std::optional<float> number();

  // Throws UserError "name:line:column: message".
  [[noreturn]] void fail(Place where, std::string_view message) const;

 private:
  void advance();
  void expect_no_directive(std::string_view after, Place where) const;

  std::string name_;
  std::string text_;
  std::size_t position_ = 0;
  int line_ = 1;
  int column_ = 1;
};

}  // namespace splatscope::isa
