#pragma once

#include <algorithm>
#include <string_view>

namespace splatscope {

// Of a trace's program names and a machine file's texts, which go to a terminal: escape sequences do things
// there. Those of ASCII, and U+0080 to U+009F in UTF-8.
inline bool has_control_characters(std::string_view text) {
  unsigned char before = 0;
  return std::ranges::any_of(text, [&](unsigned char c) {
    const bool is_long_one = before == 0xc2 && c >= 0x80 && c < 0xa0;
    before = c;
    return c < ' ' || c == 0x7f || is_long_one;
  });
}

}  // namespace splatscope
