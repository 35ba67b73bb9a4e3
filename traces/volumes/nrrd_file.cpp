#include "traces/volumes/nrrd_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>
#include <vector>

#include "model/error.h"
#include "model/stop.h"
#include "traces/volumes/nrrd_header.h"

namespace splatscope::traces {
namespace {

constexpr std::size_t kAtOnce = 1 << 16;  // values

// Values of one type from a file's bytes.
template <class Value>
void convert(std::span<const char> bytes, bool swap, float* out) {
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(Value)) {
    char value_bytes[sizeof(Value)];
    std::memcpy(value_bytes, bytes.data() + at, sizeof(Value));
    if (swap) std::reverse(value_bytes, value_bytes + sizeof(Value));
    Value value;
    std::memcpy(&value, value_bytes, sizeof(Value));
    *out++ = static_cast<float>(value);
  }
}

void convert(NrrdType type, std::span<const char> bytes, bool swap, float* out) {
  switch (type) {
    case NrrdType::int8:
      return convert<std::int8_t>(bytes, swap, out);
    case NrrdType::uint8:
      return convert<std::uint8_t>(bytes, swap, out);
    case NrrdType::int16:
      return convert<std::int16_t>(bytes, swap, out);
    case NrrdType::uint16:
      return convert<std::uint16_t>(bytes, swap, out);
    case NrrdType::int32:
      return convert<std::int32_t>(bytes, swap, out);
    case NrrdType::uint32:
      return convert<std::uint32_t>(bytes, swap, out);
    case NrrdType::float32:
      return convert<float>(bytes, swap, out);
    case NrrdType::float64:
      return convert<double>(bytes, swap, out);
  }
}

std::uintmax_t size_of(const std::filesystem::path& path, std::string_view expected) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw UserError(path.string(), 0, fmt::format("cannot be read, expected {}", expected));
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw UserError(path.string(), 0, fmt::format("cannot be read, expected {}", expected));
  return size;
}

void check_finite(std::span<const float> values, const NrrdHeader& header,
                  const std::filesystem::path& path) {
  const auto found = std::ranges::find_if(values, [](float v) { return !std::isfinite(v); });
  if (found == values.end()) return;
  const std::size_t at =
      static_cast<std::size_t>(found - values.begin()) / static_cast<std::size_t>(header.components);
  const auto columns = static_cast<std::size_t>(header.size.x),
             rows = static_cast<std::size_t>(header.size.y);
  throw UserError(path.string(), 0,
                  fmt::format("voxel ({}, {}, {}) is {}, expected finite values in single precision",
                              at % columns, at / columns % rows, at / columns / rows, *found));
}

std::filesystem::path data_of(const NrrdHeader& header, const std::filesystem::path& path) {
  return header.data_file.empty() ? path : path.parent_path() / header.data_file;
}

struct Nrrd {
  NrrdHeader header;
  std::vector<float> values;
};

Nrrd read(const std::filesystem::path& path, int components) {
  size_of(path, "a NRRD file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UserError(path.string(), 0, "cannot be read, expected a NRRD file");
  Nrrd nrrd{read_nrrd_header(in, path.string(), components), {}};
  const NrrdHeader& header = nrrd.header;
  const bool attached = header.data_file.empty();
  const std::filesystem::path data = data_of(header, path);
  const std::size_t start = (attached ? header.data_start : 0) + header.skip;
  const std::size_t width = bytes_of(header.type),
                    count = header.voxels() * static_cast<std::size_t>(components);
  const std::uintmax_t there = size_of(data, "the raw data that the header names");
  if (there < start || there - start < count * width) {
    throw UserError(data.string(), 0,
                    fmt::format("{} bytes of data, expected {} for {} x {} x {} voxels of {} bytes",
                                there < start ? 0 : there - start, count * width, header.size.x,
                                header.size.y, header.size.z, width * static_cast<std::size_t>(components)));
  }
  if (!attached) in = std::ifstream(data, std::ios::binary);
  in.clear();
  in.seekg(static_cast<std::streamoff>(start));
  nrrd.values.resize(count);
  const bool swap = header.big_endian != (std::endian::native == std::endian::big);
  std::vector<char> bytes(kAtOnce * width);
  for (std::size_t at = 0; at < count; at += kAtOnce) {
    stop_if_asked();
    const std::size_t part = std::min(kAtOnce, count - at);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(part * width))) {
      throw UserError(data.string(), 0, "cannot be read to its end, expected the voxels' data");
    }
    convert(header.type, std::span(bytes).first(part * width), swap, nrrd.values.data() + at);
  }
  check_finite(nrrd.values, header, data);
  return nrrd;
}

}  // namespace

std::filesystem::path nrrd_data_file(const std::filesystem::path& path, int components) {
  std::ifstream in(path, std::ios::binary);
  return data_of(read_nrrd_header(in, path.string(), components), path);
}

kernels::Volume read_nrrd(const std::filesystem::path& path) {
  Nrrd nrrd = read(path, 1);
  kernels::Volume volume;
  volume.size = nrrd.header.size;
  volume.spacing = nrrd.header.spacing;
  volume.origin = -0.5 * glm::dvec3(volume.size - 1) * volume.spacing;
  volume.values = std::move(nrrd.values);
  return volume;
}

glm::dvec3 VoxelPositions::at(const glm::ivec3& voxel) const {
  const auto place = static_cast<std::ptrdiff_t>(voxel.z) * size.y + voxel.y;
  const float* const xyz = &values[static_cast<std::size_t>(3 * (place * size.x + voxel.x))];
  return {xyz[0], xyz[1], xyz[2]};
}

VoxelPositions read_nrrd_positions(const std::filesystem::path& path) {
  Nrrd nrrd = read(path, 3);
  return {nrrd.header.size, std::move(nrrd.values)};
}

}  // namespace splatscope::traces
