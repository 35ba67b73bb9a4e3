#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace splatscope::traces {

// Of a line of a header: what stands between any of `separators`.
inline std::vector<std::string_view> words_of(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; (at = text.find_first_not_of(separators, at)) != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

}  // namespace splatscope::traces
