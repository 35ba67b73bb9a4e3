#include "kernels/reference/filter_value.h"

#include <gtest/gtest.h>

#include <cmath>

namespace splatscope::kernels {
namespace {

TEST(FilterValue, GaussianWithinItsCutoff) {
  ReferenceSettings settings;  // c = 1: sqrt 2
  EXPECT_DOUBLE_EQ(filter_value(settings, {1.4, -1.4}), std::exp(-1.96));
  EXPECT_EQ(filter_value(settings, {1.42, 0.0}), 0.0);
  settings.shape = CutoffShape::circle;
  EXPECT_EQ(filter_value(settings, {1.4, -1.4}), 0.0);
  EXPECT_DOUBLE_EQ(filter_value(settings, {0.0, -1.41}), std::exp(-0.5 * 1.41 * 1.41));
}

}  // namespace
}  // namespace splatscope::kernels
