#include "traces/output_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

#include "model/error.h"

namespace splatscope::traces {
namespace fs = std::filesystem;

OutputFile::OutputFile(fs::path path) : path_(std::move(path)) {
  // The process's number keeps two runs apart that write to the same place; the last one to finish wins.
  temporary_ = path_.parent_path() /
               fmt::format(".{}.{}{}", path_.stem().string(), ::getpid(), path_.extension().string());
  std::error_code error;
  if (fs::is_directory(path_, error))
    throw UserError(path_.string(), 0, "is a folder, expected a place for a file");
  if (!std::ofstream(temporary_, std::ios::binary))
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
  if (!out) throw std::runtime_error(fmt::format("{}: writing failed (is the disk full?)", path.string()));
  file.commit();
}

void write_file(const fs::path& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

void prepare_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder, error))
    throw UserError(folder.string(), 0, "cannot be made a folder, expected a writable place for the output");
  OutputFile probe(folder / "probe");
}

}  // namespace splatscope::traces
