#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace splatscope {

// What `task` says of each of 0, 1, ..., count - 1, worked out in `processes` at once. SystemC has one
// simulation in a process, so simulations that are to run beside each other need processes of their own; a
// library that may end its process is tried in one. Each is a copy of this one as it stands (fork), so a task
// can read all there is without a copy of it being made; what it changes is lost, oneTBB has one thread in
// it, and it may start none. Called where no other thread of the caller is at work with oneTBB, whose idle
// threads end first. `done` is told how many are finished. Throws what the first task to fail said, as
// UserError where that is one, else as std::runtime_error; that too where a process ends early.
std::vector<std::string> in_processes(std::size_t count, std::size_t processes,
                                      const std::function<std::string(std::size_t)>& task,
                                      const std::function<void(std::size_t)>& done = {});

}  // namespace splatscope
