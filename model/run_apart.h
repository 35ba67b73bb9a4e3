#pragma once

#include <chrono>
#include <future>
#include <thread>
#include <type_traits>

#include "model/stop.h"

namespace splatscope {

// Runs long work that does not look whether it should stop (a library's) in a thread of its own, and returns
// its result or throws what it throws. Where the program is asked to stop before it is done, throws
// Interrupted at once and leaves it behind: `work` must own all that it uses, and the process must then end
// without tidying up after threads (app/main.cpp).
template <class Work>
auto run_apart(Work work) {
  using namespace std::chrono_literals;
  std::packaged_task<std::invoke_result_t<Work&>()> task(std::move(work));
  auto result = task.get_future();
  std::thread(std::move(task)).detach();
  while (result.wait_for(20ms) != std::future_status::ready) stop_if_asked();
  return result.get();
}

}  // namespace splatscope
