#include "app/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace splatscope::app {

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), active_(!quiet && ::isatty(STDERR_FILENO) != 0) {}

void ProgressBar::clear() {
  if (shown_percent_ >= 0) fmt::print(stderr, "\r\x1b[K");  // erase to the end of the line
  shown_percent_ = -1;
}

void ProgressBar::show(double fraction_done) {
  const int percent = static_cast<int>(100 * std::clamp(fraction_done, 0.0, 1.0));
  if (percent == 100) return clear();
  if (!active_ || percent == shown_percent_) return;
  shown_percent_ = percent;
  constexpr int kWidth = 40;
  const int full = percent * kWidth / 100;
  fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3} %", label_, "", full, "", kWidth - full, percent);
  std::fflush(stderr);
}

std::function<void(double)> ProgressBar::callback() {
  if (!active_) return {};
  return [this](double fraction_done) { show(fraction_done); };
}

}  // namespace splatscope::app
