#pragma once

#include <string>
#include <string_view>

namespace splatscope {

// `text` as one word of a command line of sh: a quote within ends the word, stands escaped, and begins it
// again.
inline std::string shell_word(std::string_view text) {
  std::string word = "'";
  for (const char c : text) c == '\'' ? word += "'\\''" : word += c;
  return word + "'";
}

}  // namespace splatscope
