#include "app/progress_bar.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

namespace splatscope::app {
namespace {

TEST(ProgressBar, TellsTheTimeThatIsLeft) {
  EXPECT_EQ(time_left(65, 0.5), "1:05 left");
  EXPECT_EQ(time_left(1, 0.99), "0:00 left");
  EXPECT_EQ(time_left(10, 0.1), "1:30 left");
  EXPECT_EQ(time_left(3600, 0.25), "3:00:00 left");
  EXPECT_EQ(time_left(100, 1.5), "0:00 left");
}

TEST(ProgressBar, TellsNoTimeWhileNothingTellsIt) {
  EXPECT_EQ(time_left(0.5, 0.5), "");
  EXPECT_EQ(time_left(60, 0), "");
  EXPECT_EQ(time_left(60, 1e-9), "");
  EXPECT_EQ(time_left(60, std::numeric_limits<double>::quiet_NaN()), "");
}

// Standard error is a terminal as long as this lives.
class Terminal {
 public:
  Terminal() : before_(::dup(STDERR_FILENO)), screen_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    ::grantpt(screen_);
    ::unlockpt(screen_);
    const int keyboard = ::open(::ptsname(screen_), O_RDWR | O_NOCTTY);
    ::dup2(keyboard, STDERR_FILENO);
    ::close(keyboard);
  }
  ~Terminal() {
    ::dup2(before_, STDERR_FILENO);
    ::close(before_);
    go_away();
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  std::string shown() const {
    std::string text(1000, ' ');
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(screen_, text.data(), text.size()))));
    return text;
  }
  void go_away() {
    if (screen_ >= 0) ::close(screen_);
    screen_ = -1;
  }

 private:
  int before_, screen_;
};

TEST(ProgressBar, OutlivesItsTerminal) {
  std::string shown;
  {
    Terminal terminal;
    std::optional<ProgressBar> bar;
    bar.emplace("running", false);
    bar->show(0.25);
    shown = terminal.shown();
    terminal.go_away();
    bar->show(0.5);
    bar.reset();
  }
  EXPECT_NE(shown.find("running [##########...."), std::string::npos) << shown;
}

}  // namespace
}  // namespace splatscope::app
