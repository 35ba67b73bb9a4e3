#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "model/command/commands.h"
#include "model/render.h"
#include "model/work/work.h"
#include "traces/output_files.h"

namespace splatscope::studies {

// What the function of a trace gives the timing: computed once, timed by many machines.
struct WorkStream {
  std::vector<DrawWork> work;  // one for each Draw of the trace
  RenderCounters counters;
};

// Names what a work stream depends on, and nothing else: the trace, the options, and the program that draws
// (any other build computes it anew). 32 hexadecimal digits.
std::string work_key(const Trace& trace, const RenderOptions& options);

// Work streams in a folder, a file each, under their keys.
class WorkCache {
 public:
  // Throws UserError where there is no such folder and none can be made.
  explicit WorkCache(std::filesystem::path folder);

  enum class Found { yes, no, damaged };
  // The stream of `key`, checked against its checksum and `trace`. `damaged`: what stands there is of another
  // format or key, cut short or changed; the caller computes it again. UserError where it is no file.
  Found read(const std::string& key, const Trace& trace, WorkStream& stream) const;
  // Appears whole or not at all; UserError where it cannot be, std::runtime_error where the disk is full.
  void write(const std::string& key, const WorkStream& stream) const;
  std::filesystem::path path_of(const std::string& key) const;

 private:
  std::filesystem::path folder_;
  std::optional<traces::OutputFolder> made_;  // one that stands already may be for reading alone
};

}  // namespace splatscope::studies
