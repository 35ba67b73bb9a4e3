#include "model/command/commands.h"

namespace splatscope {

std::vector<std::size_t> frame_ends(const Trace& trace) {
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < trace.commands.size(); ++i) {
    if (std::holds_alternative<Present>(trace.commands[i])) ends.push_back(i + 1);
  }
  if (ends.empty() || ends.back() != trace.commands.size()) ends.push_back(trace.commands.size());
  return ends;
}

}  // namespace splatscope
