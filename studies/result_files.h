#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// The files of one command in its folder, which a results.json lists as `files`.
namespace splatscope::studies {

// The `files` of the results.json in `folder`: names without a folder, of kinds that results have. None where
// it is not there, or of something else: anyone's file may have the name.
std::vector<std::string> earlier_results(const std::filesystem::path& folder);

// Removes these files, and results.json itself, so that the folder holds the results of one command and,
// until that one has ended, plainly none. What no results.json lists stays, whatever its name.
void remove_earlier_results(const std::filesystem::path& folder);

// Results that appear all together: until commit() what stands in their folder stays as it is, and without it
// for good.
class ResultFiles {
 public:
  // `folder` exists.
  explicit ResultFiles(std::filesystem::path folder);
  ~ResultFiles();
  ResultFiles(const ResultFiles&) = delete;
  ResultFiles& operator=(const ResultFiles&) = delete;

  // Where to write the file called `name` meanwhile. May be called from several threads.
  std::filesystem::path place(const std::string& name) const;
  // Writes `results` and the `files` as results.json, with so many spaces a level, and puts all in the place
  // of what an earlier command left. Returns their names, results.json last. Throws UserError where one of
  // the files has no place, and then changes nothing.
  std::vector<std::string> commit(nlohmann::ordered_json results, int indent = 1);

 private:
  std::filesystem::path folder_;
  std::filesystem::path unfinished_;  // beneath it: the same disk, so a file moves at once or not at all
};

}  // namespace splatscope::studies
