#include "model/input_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "model/byte_order_mark.h"
#include "model/error.h"

namespace splatscope {
namespace {

// The parser makes a table for each part of a dotted key ("a.b.c"), and tables are taken down from the
// outside in, by recursion: a key of a hundred thousand parts would overflow the stack. Of what TOML is, this
// knows what can hold a dot: strings, comments and numbers, which have one at most.
class KeyDepthCheck {
 public:
  KeyDepthCheck(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  void run() {
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') ++line_;
      quote_ == 0 ? outside_of_strings() : in_a_string();
    }
  }

 private:
  static constexpr std::size_t kMostDots = 64;

  bool three_quotes() const {
    return at_ + 2 < text_.size() && text_[at_ + 1] == text_[at_] && text_[at_ + 2] == text_[at_];
  }

  void outside_of_strings() {
    constexpr std::string_view kAroundKeys = "=,[]{}\n";
    const char c = text_[at_];
    if (c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
    } else if (c == '"' || c == '\'') {
      quote_ = c;
      has_lines_ = three_quotes();
      if (has_lines_) at_ += 2;
    } else if (c == '.' && ++dots_ > kMostDots) {
      throw UserError(file_, line_, "a key of too many parts, expected TOML of a table and a key");
    } else if (kAroundKeys.find(c) != std::string_view::npos) {
      dots_ = 0;
    }
  }

  void in_a_string() {
    const char c = text_[at_];
    if (c == '\\' && quote_ == '"') {
      if (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;  // an escaped quote ends no string
    } else if (c == '\n' && !has_lines_) {
      quote_ = 0;  // no TOML, as the parser will say
      dots_ = 0;
    } else if (c == quote_ && (!has_lines_ || three_quotes())) {
      if (has_lines_) at_ += 2;
      for (int own = 0; has_lines_ && own < 2 && at_ + 1 < text_.size() && text_[at_ + 1] == c; ++own)
        ++at_;  // quotes before the closing three are the string's
      quote_ = 0;
    }
  }

  std::string_view text_, file_;
  std::size_t at_ = 0, dots_ = 0;
  int line_ = 1;
  char quote_ = 0;          // of the string that is open; 0: none
  bool has_lines_ = false;  // three quotes began it
};

}  // namespace

std::string file_bytes(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::string bytes(error ? 0 : size, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

std::string read_text_file(const std::filesystem::path& path, std::string_view expected) {
  std::error_code error;
  const bool folder = std::filesystem::is_directory(path, error);
  std::ifstream in(path, std::ios::binary);
  if (folder || !in) throw UserError(path.string(), 0, fmt::format("cannot be read, expected {}", expected));
  std::string text(kMostTextBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) throw UserError(path.string(), 0, fmt::format("cannot be read, expected {}", expected));
  if (text.size() > kMostTextBytes)
    throw UserError(path.string(), 0, fmt::format("is larger than 1 MiB, expected {}", expected));
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  return text;
}

std::string toml_string(const std::string& text) {
  std::ostringstream out;
  out << toml::value<std::string>(text);
  return out.str();
}

toml::table parse_toml(std::string_view text, std::string_view file) {
  KeyDepthCheck(text, file).run();
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw UserError(file, static_cast<int>(error.source().begin.line),
                    fmt::format("{}, expected TOML", error.description()));
  }
}

}  // namespace splatscope
