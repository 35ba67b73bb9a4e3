#include "studies/run_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/error.h"
#include "studies/result_files.h"

namespace splatscope::studies {
namespace fs = std::filesystem;

namespace {

// Of some run: what it is asked for says which. Pictures of earlier frames have names beyond these.
constexpr std::string_view kResults[] = {
    "frame.exr",         "frame.png",           "depth.exr",      "results.json", "report.html",
    "reference.exr",     "reference.png",       "difference.png", "overdraw.exr", "depth_fails.exr",
    "texel_fetches.exr", "cycles_per_tile.exr", "sweep.csv"};

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

std::vector<traces::NamedFile> files_of(const Opened& opened) {
  if (const auto* scene = std::get_if<traces::Scene>(&opened)) return scene->files;
  if (const auto* volume = std::get_if<traces::VolumeScene>(&opened)) return volume->files;
  return {};
}

void expect_apart_from_results(const std::vector<traces::NamedFile>& files, const fs::path& folder) {
  std::vector<traces::NamedFile> results;
  for (const std::string_view name : kResults) {
    results.push_back({"a result in --out", folder / name});
    std::error_code error;
    if (fs::is_directory(folder / name, error))
      throw UserError((folder / name).string(), 0, "is a folder, expected a place for a file");
  }
  for (const std::string& name : earlier_results(folder))
    results.push_back({"an earlier result in --out", folder / name});
  for (const traces::NamedFile& file : files)
    if (is_earlier_frame(file.path.filename().string()))
      results.push_back({"a result in --out", folder / file.path.filename()});
  traces::expect_apart(files, results);
}

}  // namespace splatscope::studies
