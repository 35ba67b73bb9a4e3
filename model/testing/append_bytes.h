#pragma once

#include <algorithm>
#include <cstring>
#include <string>

namespace splatscope {

// The bytes of a number behind those of a binary file (on a little-endian host).
template <class Value>
void append_bytes(std::string& bytes, Value value, bool big_endian) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian) std::reverse(raw, raw + sizeof value);
  bytes.append(raw, sizeof value);
}

}  // namespace splatscope
