#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <iosfwd>
#include <string>
#include <string_view>

namespace splatscope::traces {

enum class NrrdType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

// What a NRRD header says of a volume.
struct NrrdHeader {
  NrrdType type = NrrdType::uint8;
  bool big_endian = false;
  glm::ivec3 size{};           // each in [1, kMostAlong], their product at most kMostVoxels
  glm::dvec3 spacing{1.0};     // finite, > 0
  std::string data_file;       // of a detached header, as it stands there; empty: the data follow
  std::size_t skip = 0;        // bytes before the data
  std::size_t data_start = 0;  // of an attached header: bytes from the file's beginning

  static constexpr int kMostAlong = 1 << 15;
  static constexpr std::size_t kMostVoxels = std::size_t{1} << 29;
  int components = 1;  // 3: a first axis of three numbers a voxel
  std::size_t voxels() const {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
           static_cast<std::size_t>(size.z);
  }
};

std::size_t bytes_of(NrrdType type);

// Reads a header up to its end, an empty line or the end of the file. `file` is for messages. Throws
// UserError "file:line: ...": not NRRD, a field that is missing, given twice or out of range, or what this
// reader does not do (an encoding other than raw, dimensions other than 3, several data files). With three
// `components` it expects a first axis of three, and does not look at spacings and directions.
NrrdHeader read_nrrd_header(std::istream& in, std::string_view file, int components = 1);

}  // namespace splatscope::traces
