#include "studies/run_observers.h"

#include <gtest/gtest.h>

#include "model/error.h"

namespace splatscope::studies {
namespace {

TEST(RunObservers, WindowsAreTwoCycles) {
  EXPECT_EQ(100u, window_of("100:200", "--timeline-window").first);
  EXPECT_EQ(200u, window_of("100:200", "--timeline-window").last);
  EXPECT_EQ(0u, window_of(":200", "--timeline-window").first);
  EXPECT_EQ(sim::kNever, window_of("100:", "--timeline-window").last);
  EXPECT_EQ(sim::kNever, window_of("", "--timeline-window").last);
  for (const char* wrong : {"100", "200:100", "a:b", "1:2:3", "-1:5", "1:2x", "99999999999999999999:"}) {
    EXPECT_THROW(window_of(wrong, "--timeline-window"), UserError) << wrong;
  }
}

}  // namespace
}  // namespace splatscope::studies
