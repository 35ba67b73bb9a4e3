#pragma once

#include <algorithm>
#include <string_view>

namespace splatscope {

// Of a name from a file, which goes to a terminal: escape sequences do things there.
inline bool has_control_characters(std::string_view text) {
  return std::ranges::any_of(text, [](unsigned char c) { return c < ' ' || c == 0x7f; });
}

}  // namespace splatscope
