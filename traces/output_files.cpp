#include "traces/output_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <fstream>
#include <stdexcept>

#include "model/error.h"

namespace splatscope::traces {
namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail_for_disk(const fs::path& path) {
  throw std::runtime_error(fmt::format("{}: writing failed (is the disk full?)", path.string()));
}

// One file, or one place for a file that is not there yet.
bool same_place(const fs::path& a, const fs::path& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code error;
  if (fs::exists(a, error) && fs::exists(b, error)) return fs::equivalent(a, b, error);
  const fs::path whole_a = fs::weakly_canonical(fs::absolute(a, error), error);
  return !error && whole_a == fs::weakly_canonical(fs::absolute(b, error), error) && !error;
}

// By whatever link: /dev/stdout would be renamed over, for everyone, where the shell made a file of it.
bool is_standard_stream(const fs::path& path) {
  return std::ranges::any_of(std::array{STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}, [&](int stream) {
    return same_place(path, fmt::format("/proc/self/fd/{}", stream));
  });
}

// What other programs take for standard output.
void refuse_dash(const fs::path& path) {
  if (path == "-")
    throw UserError("-", 0,
                    "is not standard output here, expected a file's or folder's name (./- for one called -)");
}

void expect_writable(const fs::path& folder) {
  try {
    const OutputFile probe(folder / fmt::format(".probe-{}", ::getpid()));
  } catch (const UserError&) {  // which would name the probe
    throw UserError(folder.string(), 0, "cannot be written into, expected a writable place for the output");
  }
}

}  // namespace

void expect_apart(const std::vector<NamedFile>& written, const std::vector<NamedFile>& others) {
  for (const NamedFile& file : written) {
    for (const NamedFile& other : others) {
      if (!same_place(file.path, other.path)) continue;
      throw UserError(file.path.string(), 0,
                      fmt::format("is named by {} and by {} ({}), expected a file of its own for each",
                                  file.what, other.what, other.path.string()));
    }
  }
}

OutputFile::OutputFile(fs::path path) : path_(std::move(path)) {
  std::error_code error;
  refuse_dash(path_);
  if (path_.filename().empty())
    throw UserError(fmt::format("\"{}\"", path_.string()), 0, "names no file, expected a place for one");
  const fs::file_status there = fs::status(path_, error);
  if (error == std::errc::filename_too_long)
    throw UserError(path_.string(), 0, "is too long a name, expected a shorter one");
  if (fs::is_directory(there)) throw UserError(path_.string(), 0, "is a folder, expected a place for a file");
  if (fs::exists(there) && !fs::is_regular_file(there))  // /dev/null must stay what it is
    throw UserError(path_.string(), 0, "is no ordinary file, expected a place for one");
  if (is_standard_stream(path_))
    throw UserError(path_.string(), 0,
                    "is standard input, output or error of this run, expected a file of its own");
  if (fs::is_symlink(path_, error)) {  // the link stays
    const fs::path place = fs::weakly_canonical(path_, error);
    if (error || fs::is_symlink(place, error))
      throw UserError(path_.string(), 0, "is a link that leads nowhere, expected a place for a file");
    path_ = place;
  }
  // The process's number keeps two runs apart that write to the same place; the last one to finish wins.
  static std::atomic<unsigned> files = 0;
  temporary_ = path_.parent_path() / fmt::format(".unfinished.{}.{}", ::getpid(), ++files);
  errno = 0;
  if (std::ofstream(temporary_, std::ios::binary)) return;
  if (errno == ENOSPC || errno == EDQUOT) fail_for_disk(path_);
  throw UserError(path_.string(), 0, "cannot be written, expected a file name in a writable folder");
}

OutputFile::~OutputFile() {
  std::error_code error;  // a failure to tidy up must not hide the failure that led here
  if (!temporary_.empty()) fs::remove(temporary_, error);
}

void OutputFile::commit() {
  fs::rename(temporary_, path_);
  temporary_.clear();
}

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
  OutputFile file(path);
  std::ofstream out(file.temporary(), std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) fail_for_disk(path);
  file.commit();
}

void write_file(const fs::path& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)) {
  std::error_code error;
  refuse_dash(path_);
  const auto is_free = [&](const fs::path& folder) {  // not even a link that leads nowhere stands there
    return fs::symlink_status(folder, error).type() == fs::file_type::not_found;
  };
  for (fs::path folder = path_; !folder.empty() && is_free(folder); folder = folder.parent_path())
    made_.push_back(folder);
  fs::create_directories(path_, error);
  try {
    if (!fs::is_directory(path_, error))
      throw UserError(path_.string(), 0, "cannot be made a folder, expected a writable place for the output");
    expect_writable(path_);
  } catch (...) {
    take_back();
    throw;
  }
}

OutputFolder::~OutputFolder() {
  take_back();
}

void OutputFolder::take_back() {
  std::error_code error;  // a folder that holds something stays: that is an error here
  for (const fs::path& folder : made_) fs::remove(folder, error);
}

}  // namespace splatscope::traces
