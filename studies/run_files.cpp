#include "studies/run_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace splatscope::studies {
namespace fs = std::filesystem;

namespace {

// Of some run: what it is asked for says which. Pictures of earlier frames have names beyond these.
constexpr std::string_view kResults[] = {"frame.exr",       "frame.png",         "depth.exr",
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

bool is_result(std::string_view name) {
  return std::ranges::count(kResults, name) > 0 || is_earlier_frame(name);
}

// As a results.json has it. None where it is not there, or of something else: anyone's file may have the
// name.
std::vector<std::string> listed_files(const fs::path& results) {
  if (!fs::is_regular_file(results)) return {};
  std::ifstream in(results, std::ios::binary);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  std::vector<std::string> names;
  if (!json.is_object() || !json.contains("files")) return names;
  for (const auto& name : json["files"])
    if (name.is_string()) names.push_back(name);
  return names;
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
  for (const std::string_view name : kResults) results.push_back({"a result in --out", folder / name});
  for (const traces::NamedFile& file : files)
    if (is_earlier_frame(file.path.filename().string()))
      results.push_back({"a result in --out", folder / file.path.filename()});
  traces::expect_apart(files, results);
}

void remove_earlier_results(const fs::path& folder, const std::vector<std::string>& kept) {
  for (const std::string& name : listed_files(folder / "results.json")) {
    const fs::path file = folder / name;
    if (is_result(name) && std::ranges::count(kept, name) == 0 && !fs::is_directory(file)) fs::remove(file);
  }
}

}  // namespace splatscope::studies
