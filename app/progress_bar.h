#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace splatscope::app {

// "1:05 left" or "2:03:04 left", as far as the time up to now tells; empty while that is too little to tell:
// less than a second, or nothing done.
std::string time_left(double seconds_so_far, double fraction_done);

// A line on standard error that shows how far long work is, and how long it will take: only where that is a
// terminal, and not with `quiet`.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double fraction_done);  // 0 to 1; at 1 the line goes, so that results can be printed
  // show(), for work that reports its progress; empty where nothing is shown.
  std::function<void(double)> callback();
  void clear();

 private:
  std::string label_;
  bool active_;
  std::chrono::steady_clock::time_point start_;
  std::string shown_;  // the line; empty: none
};

}  // namespace splatscope::app
