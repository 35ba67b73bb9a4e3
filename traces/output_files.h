#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

// Files that appear whole or not at all.
namespace splatscope::traces {

// A file under a temporary name beside `path`, which takes its place by commit(). Without commit it goes
// away.
class OutputFile {
 public:
  // Throws UserError where no file can be made there.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Write here: same folder and ending as `path`.
  const std::filesystem::path& temporary() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

// Throws UserError where the place is not writable, std::runtime_error where writing fails later (a full
// disk).
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

// Makes the folder and its parents where they are missing. Throws UserError where that, or a file in it,
// cannot be made: called before long work, so that it does not end with nowhere to put its result.
void prepare_output_folder(const std::filesystem::path& folder);

}  // namespace splatscope::traces
