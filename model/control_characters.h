#pragma once

#include <cstddef>
#include <string_view>

namespace splatscope {

// Of texts that go to a terminal, where escape sequences do things: a trace's program names, what a machine
// file says, messages.

// The bytes of the control character that `text` begins with: of ASCII, or U+0080 to U+009F in UTF-8. 0:
// none.
inline std::size_t leading_control_character(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0xff;
  };
  if (byte(0) < ' ' || byte(0) == 0x7f) return 1;
  return byte(0) == 0xc2 && byte(1) >= 0x80 && byte(1) < 0xa0 ? 2 : 0;
}

inline bool has_control_characters(std::string_view text) {
  for (; !text.empty(); text.remove_prefix(1))
    if (leading_control_character(text) != 0) return true;
  return false;
}

}  // namespace splatscope
