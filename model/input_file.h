#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <string_view>

// Files that people write by hand: programs, scenes, machines.
namespace splatscope {

inline constexpr std::size_t kMostTextBytes = 1 << 20;

// All of a file, or of a pipe, but a byte order mark before its text. Throws UserError
// "path: ..., expected WHAT" where it is missing, a folder, or larger than kMostTextBytes, of which no more
// is read.
std::string read_text_file(const std::filesystem::path& path, std::string_view expected);

// All of a regular file, or what of it can be read.
std::string file_bytes(const std::filesystem::path& path);

// The text as a string of TOML, in quotes.
std::string toml_string(const std::string& text);

// Throws UserError "file:line: ..." where `text` is no TOML, or names tables within tables so deep that no
// file of splatscope could mean it.
toml::table parse_toml(std::string_view text, std::string_view file);

}  // namespace splatscope
