#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <utility>

#include "model/stop.h"
#include "model/work/work.h"

namespace splatscope::studies {

// The parts of a frame's work on their way from where it is computed to the thread that times it.
class WorkQueue {
 public:
  // `ahead`: that wait at most, 2 or more. Who finds no room goes on when half of them are taken, not at each
  // one.
  explicit WorkQueue(std::size_t ahead) : ahead_(ahead) {}

  // ---- those that compute, one at a time; waits while there is no room. Throws Interrupted after stop().
  // Leaves in its place one that was taken before, if there is one, whose memory can be used again.
  void put(DrawWork& work) {
    std::unique_lock lock(mutex_);
    if (waiting_.size() == ahead_)
      changed_.wait(lock, [&] { return waiting_.size() <= ahead_ / 2 || stopped_; });
    if (stopped_) throw Interrupted();
    waiting_.push_back(std::exchange(work, std::move(done_with_)));
    done_with_ = {};
    changed_.notify_all();
  }
  // No more comes, for this reason.
  void fail(std::exception_ptr reason) {
    const std::lock_guard lock(mutex_);
    failure_ = std::move(reason);
    changed_.notify_all();
  }

  // ---- the thread that times: the next one, which stays until the next call. Throws what fail() was given.
  const DrawWork& next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !waiting_.empty() || failure_; });
    if (waiting_.empty()) std::rethrow_exception(failure_);
    done_with_ = std::exchange(taken_, std::move(waiting_.front()));
    waiting_.pop_front();
    if (waiting_.size() == ahead_ / 2) changed_.notify_all();
    return taken_;
  }
  // What comes is not wanted any more.
  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

 private:
  const std::size_t ahead_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<DrawWork> waiting_;
  DrawWork taken_, done_with_;
  std::exception_ptr failure_;
  bool stopped_ = false;
};

}  // namespace splatscope::studies
