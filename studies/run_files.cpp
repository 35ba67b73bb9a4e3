#include "studies/run_files.h"

#include <fmt/format.h>

#include <algorithm>

namespace splatscope::studies {
namespace fs = std::filesystem;

namespace {

// Of some run: what it is asked for says which. Pictures of earlier frames have names beyond these.
constexpr const char* kResults[] = {"frame.exr",       "frame.png",         "depth.exr",
                                    "results.json",    "report.html",       "reference.exr",
                                    "reference.png",   "difference.png",    "overdraw.exr",
                                    "depth_fails.exr", "texel_fetches.exr", "cycles_per_tile.exr"};

// "frame-000.png"
bool is_earlier_frame(std::string_view name) {
  constexpr std::string_view kStart = "frame-", kEnd = ".png";
  if (!name.starts_with(kStart) || !name.ends_with(kEnd)) return false;
  if (name.size() < kStart.size() + 3 + kEnd.size()) return false;
  name = name.substr(kStart.size(), name.size() - kStart.size() - kEnd.size());
  return std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::string picture_name(std::size_t number, std::size_t frames) {
  return number + 1 == frames ? "frame.png" : fmt::format("frame-{:03}.png", number);
}

void expect_apart_from_results(const std::vector<traces::NamedFile>& files, const fs::path& folder) {
  std::vector<traces::NamedFile> results;
  for (const char* name : kResults) results.push_back({"a result in --out", folder / name});
  for (const traces::NamedFile& file : files)
    if (is_earlier_frame(file.path.filename().string()))
      results.push_back({"a result in --out", folder / file.path.filename()});
  traces::expect_apart(files, results);
}

void remove_other_results(const fs::path& folder, const std::vector<std::string>& kept) {
  std::vector<fs::path> others;  // first all, then remove: the folder is not to change while it is read
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool result = std::ranges::count(kResults, name) > 0 || is_earlier_frame(name);
    if (result && std::ranges::count(kept, name) == 0 && !entry.is_directory()) others.push_back(entry);
  }
  for (const fs::path& other : others) fs::remove(other);
}

}  // namespace splatscope::studies
