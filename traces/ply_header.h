#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace splatscope::traces {

enum class PlyEncoding { ascii, binary_little_endian, binary_big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::string_view name(PlyEncoding encoding);  // as the header has them
std::string_view name(PlyType type);

constexpr std::size_t size_in_bytes(PlyType type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<int>(type)];
}

constexpr bool is_integer(PlyType type) {
  return type < PlyType::float32;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  // of each item, where it is a list
  bool is_list = false;
  PlyType count_type = PlyType::uint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> texture_comments;  // lines "comment TextureFile NAME"
  int lines = 0;                              // the data begins on the next one
};

// Reads up to and with the line "end_header". Throws UserError "file:line: ...".
PlyHeader read_ply_header(std::istream& in, std::string_view file);

}  // namespace splatscope::traces
