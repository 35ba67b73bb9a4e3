#pragma once

#include <atomic>
#include <exception>

namespace splatscope {

// Thrown out of long work that was asked to stop, so that destructors take half-written files away. No error
// of anybody's.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

// The signal that asked the process to stop; 0: none has. A handler of signals can reach nothing but a global
// (and only one without a lock), so this is the only one of the program.
inline constinit std::atomic<int> stop_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free);

// Called by every loop that may take long, some hundred times a second or more, from any thread: a load and a
// branch. Throws Interrupted.
inline void stop_if_asked() {
  if (stop_signal.load(std::memory_order_relaxed) != 0) [[unlikely]]
    throw Interrupted();
}

}  // namespace splatscope
