#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

namespace splatscope::traces {

// For fuzzers of readers that open a file: one that is written anew for each input, and goes away in the end.
class FuzzFile {
 public:
  explicit FuzzFile(std::string_view ending)
      : path_(std::filesystem::temp_directory_path() /
              fmt::format("splatscope-fuzz-{}{}", ::getpid(), ending)) {}
  ~FuzzFile() {
    std::error_code error;  // a failure to tidy up must not end the fuzzer
    std::filesystem::remove(path_, error);
  }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;

  void write(const std::uint8_t* data, std::size_t size) const {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace splatscope::traces
