#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "model/temporary_folder.h"
#include "model/testing/error_of.h"

// Files that tests write and read.
namespace splatscope {

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class ScratchFolder : public TemporaryFolder {
 public:
  std::filesystem::path file(std::string_view name, std::string_view text) const {
    std::ofstream(path() / name, std::ios::binary) << text;
    return path() / name;
  }

  // As splatscope::error_of, without this folder before the name of a file in it.
  template <typename Run>
  std::string error_of(Run run) const {
    const std::string error = splatscope::error_of(run), folder = path().string() + '/';
    return error.starts_with(folder) ? error.substr(folder.size()) : error;
  }

  // Names of everything in it, hidden files too, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path()))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
};

}  // namespace splatscope
