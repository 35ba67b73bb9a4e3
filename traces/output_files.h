#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

  // Write here: in the folder of `path`.
  const std::filesystem::path& temporary() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

// A file of a command line, and what names it there: "SCENE", "--counters".
struct NamedFile {
  std::string what;
  std::filesystem::path path;
};

// Throws UserError where one of `written` has the place of one of `others`, by whatever names and links: to
// write the one would destroy the other.
void expect_apart(const std::vector<NamedFile>& written, const std::vector<NamedFile>& others);

// Throws UserError where the place is not writable, std::runtime_error where writing fails later (a full
// disk).
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

// A folder for output. It and its parents are made where they are missing; those of them that are still empty
// in the end go away again, so work that fails before its first file leaves nothing. Made before long work,
// which then does not end with nowhere to put its result.
class OutputFolder {
 public:
  // Throws UserError where the folder, or a file in it, cannot be made.
  explicit OutputFolder(std::filesystem::path path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  void take_back();

  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  // innermost first
};

}  // namespace splatscope::traces
