#include "studies/result_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "studies/json_text.h"
#include "traces/output_files.h"

namespace splatscope::studies {
namespace fs = std::filesystem;

namespace {

constexpr const char* kResults = "results.json";

bool is_result(const fs::path& name) {
  constexpr std::array kKinds{".exr", ".png", ".svg", ".html", ".json", ".csv"};
  return name == name.filename() && std::ranges::count(kKinds, name.extension()) > 0;
}

}  // namespace

std::vector<std::string> earlier_results(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;  // what cannot be looked at is found, and said, by who writes there
  if (!fs::is_regular_file(folder / kResults, error)) return names;
  std::ifstream in(folder / kResults, std::ios::binary);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("host") || !json.contains("files")) return names;
  for (const auto& name : json["files"])
    if (name.is_string() && is_result(name.get<std::string>())) names.push_back(name);
  return names;
}

void remove_earlier_results(const fs::path& folder) {
  std::vector<std::string> names = earlier_results(folder);
  names.emplace_back(kResults);  // last: it says what else is to go
  std::error_code error;         // a link to itself is no folder
  for (const std::string& name : names)
    if (!fs::is_directory(folder / name, error)) fs::remove(folder / name);
}

ResultFiles::ResultFiles(fs::path folder)
    : folder_(std::move(folder)), unfinished_(folder_ / fmt::format(".unfinished.{}", ::getpid())) {}

ResultFiles::~ResultFiles() {
  std::error_code error;  // a failure to tidy up must not hide the failure that led here
  fs::remove_all(unfinished_, error);
}

fs::path ResultFiles::place(const std::string& name) const {
  std::error_code error;  // is found, and said, by who writes the file
  fs::create_directory(unfinished_, error);
  return unfinished_ / name;
}

std::vector<std::string> ResultFiles::commit(nlohmann::ordered_json results, int indent) {
  std::vector<std::string> names;
  if (fs::exists(unfinished_)) {
    for (const auto& file : fs::directory_iterator(unfinished_))
      names.push_back(file.path().filename().string());
  }
  std::ranges::sort(names);
  names.emplace_back(kResults);  // last: where it stands, all of them do
  results["files"] = names;
  traces::write_file(place(kResults), json_text(results, indent) + "\n");
  for (const std::string& name : names) const traces::OutputFile probe(folder_ / name);
  remove_earlier_results(folder_);
  for (const std::string& name : names) fs::rename(unfinished_ / name, folder_ / name);
  return names;
}

}  // namespace splatscope::studies
