#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "traces/scene.h"

namespace splatscope::traces {

// Surfels as they stand in a PLY file, unchecked: values may be NaN or zero.
struct PointFile {
  std::vector<Surfel> surfels;  // color: white where the file has none
  bool has_normals = false;     // nx ny nz; as in the file, of any length
  bool has_radii = false;       // radius
  std::vector<float> values;    // of the property `value`, a data set's; empty where the file has none
};

inline constexpr std::uint64_t kMostSurfels = 1 << 26;  // of a file

// Reads the element "vertex" of a PLY file (ASCII, or binary of either byte order): x y z, and where they are
// there nx ny nz, radius, red green blue, value. Order and type of the properties are free; others, lists
// too, are passed over, as are other elements. Colours of an integer type are divided by their full scale
// (ushort: 65535, else 255). A line of an ASCII file is a row, unless it is blank. Throws UserError
// "file:line: ..." (header, ASCII) or "file: ... at byte N ..." (binary): missing, truncated, not PLY, x, y
// or z absent, half a group given; in ASCII also a row of another length, and rows that the header does not
// count. Memory is bounded by a small multiple of the file's size.
PointFile read_ply(const std::filesystem::path& path);

// Whether a PLY file has an element "face" that is not empty: a mesh. Throws UserError where the header is
// wrong or counts more than the file can hold, and where a mesh has triangle strips, or vertices with half a
// group of properties or colours of a type, that assimp reads wrongly.
bool ply_has_faces(const std::filesystem::path& path);

// Writes what read_ply reads, as a binary file: position, normal, radius, and color in 8 bits. Whole or not
// at all (output_files.h).
void write_ply(std::span<const Surfel> surfels, const std::filesystem::path& path);

}  // namespace splatscope::traces
