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

void check_finite(const kernels::Volume& volume, const std::filesystem::path& path) {
  const auto found = std::ranges::find_if(volume.values, [](float v) { return !std::isfinite(v); });
  if (found == volume.values.end()) return;
  const std::size_t at = static_cast<std::size_t>(found - volume.values.begin());
  const auto columns = static_cast<std::size_t>(volume.size.x),
             rows = static_cast<std::size_t>(volume.size.y);
  throw UserError(path.string(), 0,
                  fmt::format("voxel ({}, {}, {}) is {}, expected finite values in single precision",
                              at % columns, at / columns % rows, at / columns / rows, *found));
}

}  // namespace

kernels::Volume read_nrrd(const std::filesystem::path& path) {
  size_of(path, "a NRRD file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UserError(path.string(), 0, "cannot be read, expected a NRRD file");
  const NrrdHeader header = read_nrrd_header(in, path.string());
  const bool attached = header.data_file.empty();
  const std::filesystem::path data = attached ? path : path.parent_path() / header.data_file;
  const std::size_t start = (attached ? header.data_start : 0) + header.skip;
  const std::size_t width = bytes_of(header.type), needed = header.voxels() * width;
  const std::uintmax_t there = size_of(data, "the raw data that the header names");
  if (there < start || there - start < needed) {
    throw UserError(data.string(), 0,
                    fmt::format("{} bytes of data, expected {} for {} x {} x {} voxels of {} bytes",
                                there < start ? 0 : there - start, needed, header.size.x, header.size.y,
                                header.size.z, width));
  }
  if (!attached) in = std::ifstream(data, std::ios::binary);
  in.clear();
  in.seekg(static_cast<std::streamoff>(start));
  kernels::Volume volume = kernels::centered_volume(header.size, header.spacing);
  const bool swap = header.big_endian != (std::endian::native == std::endian::big);
  std::vector<char> bytes(kAtOnce * width);
  for (std::size_t at = 0; at < volume.values.size(); at += kAtOnce) {
    stop_if_asked();
    const std::size_t count = std::min(kAtOnce, volume.values.size() - at);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(count * width))) {
      throw UserError(data.string(), 0, "cannot be read to its end, expected the voxels' data");
    }
    convert(header.type, std::span(bytes).first(count * width), swap, volume.values.data() + at);
  }
  check_finite(volume, data);
  return volume;
}

}  // namespace splatscope::traces
