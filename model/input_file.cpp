#include "model/input_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "model/byte_order_mark.h"
#include "model/error.h"

namespace splatscope {
namespace {

// The most dots between the parts of one key ("a.b.c") in the line that begins at `text`: not those in
// strings and comments. A number has one at most.
std::size_t dots_of_key(std::string_view text) {
  constexpr std::string_view kAroundKeys = "=,[]{}";
  std::size_t dots = 0, most = 0;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n' || (c == '#' && quote == 0)) break;
    if (c == '\\' && quote == '"') {
      ++i;  // an escaped quote ends no string
    } else if (c == quote) {
      quote = 0;
    } else if (quote == 0) {
      if (c == '"' || c == '\'') quote = c;
      if (c == '.') most = std::max(most, ++dots);
      if (kAroundKeys.find(c) != std::string_view::npos) dots = 0;
    }
  }
  return most;
}

// The parser makes a table for each part of a dotted key, and tables are taken down from the outside in, by
// recursion: a key of a hundred thousand parts would overflow the stack.
void check_depth(std::string_view text, std::string_view file) {
  constexpr std::size_t kMostDots = 64;
  int line = 1;
  for (std::size_t at = 0; at < text.size(); ++line) {
    if (dots_of_key(text.substr(at)) > kMostDots)
      throw UserError(file, line, "a key of too many parts, expected TOML of a table and a key");
    at = std::min(text.find('\n', at), text.size() - 1) + 1;
  }
}

}  // namespace

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
  check_depth(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw UserError(file, static_cast<int>(error.source().begin.line),
                    fmt::format("{}, expected TOML", error.description()));
  }
}

}  // namespace splatscope
