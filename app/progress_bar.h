#pragma once

#include <functional>
#include <string>

namespace splatscope::app {

// A line on standard error that shows how far long work is: only where that is a terminal, and not with
// `quiet`.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double fraction_done);  // 0 to 1; at 1 the line goes, so that results can be printed
  std::function<void(double)>
  callback();  // show(), for what reports its progress; empty where nothing is shown
  void clear();

 private:
  std::string label_;
  bool active_;
  int shown_percent_ = -1;
};

}  // namespace splatscope::app
