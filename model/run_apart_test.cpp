#include "model/run_apart.h"

#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <stdexcept>
#include <vector>

namespace splatscope {
namespace {

TEST(RunApart, GivesWhatTheWorkGives) {
  EXPECT_EQ(run_apart([] { return std::vector<int>{1, 2}; }), (std::vector<int>{1, 2}));
  EXPECT_THROW(run_apart([]() -> int { throw std::range_error("no"); }), std::range_error);
}

// The work goes on until the test lets it end: after it was left.
TEST(RunApart, LeavesWorkThatIsAskedToStop) {
  struct Gates {
    std::promise<void> open, passed;
  };
  const auto gates = std::make_shared<Gates>();
  std::thread ctrl_c([] { stop_signal = SIGINT; });
  EXPECT_THROW(run_apart([gates] {
                 gates->open.get_future().wait();
                 gates->passed.set_value();
                 return 0;
               }),
               Interrupted);
  ctrl_c.join();
  gates->open.set_value();
  gates->passed.get_future().wait();
  stop_signal = 0;
}

}  // namespace
}  // namespace splatscope
