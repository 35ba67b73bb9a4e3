#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace splatscope::traces {

// All of a regular file.
inline std::string file_bytes(const std::filesystem::path& path) {
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace splatscope::traces
