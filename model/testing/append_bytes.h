#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
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

// check(its name in PLY and NRRD, PLY's other name, its least value, its largest) for each type of whole
// numbers: a type of another size or without a sign would tell these apart.
template <class Check>
void on_each_whole_type(Check check) {
  const auto on = [&]<class Value>(const char* name, const char* other, Value) {
    check(name, other, std::numeric_limits<Value>::min(), std::numeric_limits<Value>::max());
  };
  on("int8", "char", std::int8_t{});
  on("uint8", "uchar", std::uint8_t{});
  on("int16", "short", std::int16_t{});
  on("uint16", "ushort", std::uint16_t{});
  on("int32", "int", std::int32_t{});
  on("uint32", "uint", std::uint32_t{});
}

}  // namespace splatscope
