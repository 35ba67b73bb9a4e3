#include "app/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace splatscope::app {
namespace {

// A terminal that has gone away is no reason to end the work, so nobody looks whether this arrives.
void put(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

std::string time_left(double seconds_so_far, double fraction_done) {
  constexpr double kMost = 100 * 3600;  // beyond it no guess is worth much
  if (!(seconds_so_far >= 1 && fraction_done > 0)) return {};
  const double left = seconds_so_far / fraction_done * (1 - std::min(fraction_done, 1.0));
  if (!(left < kMost)) return {};
  const int seconds = static_cast<int>(std::lround(left));
  if (seconds < 3600) return fmt::format("{}:{:02} left", seconds / 60, seconds % 60);
  return fmt::format("{}:{:02}:{:02} left", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)),
      active_(!quiet && ::isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()) {}

void ProgressBar::clear() {
  if (!shown_.empty()) put("\r\x1b[K");  // erase to the end of the line
  shown_.clear();
}

void ProgressBar::show(double fraction_done) {
  const double done = std::clamp(fraction_done, 0.0, 1.0);
  if (done == 1) return clear();
  if (!active_) return;
  constexpr int kWidth = 40;
  const int full = static_cast<int>(done * kWidth);
  const std::chrono::duration<double> so_far = std::chrono::steady_clock::now() - start_;
  std::string line = fmt::format("\r{} [{:#<{}}{:.<{}}] {:3} %  {:<12}", label_, "", full, "", kWidth - full,
                                 static_cast<int>(100 * done), time_left(so_far.count(), done));
  if (line == shown_) return;
  shown_ = std::move(line);
  put(shown_);
}

std::function<void(double)> ProgressBar::callback() {
  if (!active_) return {};
  return [this](double fraction_done) { show(fraction_done); };
}

}  // namespace splatscope::app
