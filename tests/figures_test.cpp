#include <gtest/gtest.h>

#include <cmath>

#include "program.h"

// Figures of `reproduce` that no page quotes.
namespace splatscope::tests {
namespace {

// Beside the ellipse in double precision, the vertex program's parallelogram is as large, in the card's
// arithmetic.
TEST(Figures, TheQuadOfFigure8HoldsItsFilter) {
  const ScratchFolder folder;
  const Outcome outcome = run_program({"reproduce", "fig8", "--quiet", "--out", "out"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto found = results_in(folder.path() / "out")["fig8"];
  const double r0 = found["r0"], r1 = found["r1"], error = found["half_diagonal_error"];
  EXPECT_GT(r1, 1) << "the reconstruction kernel alone has axes of 1";
  EXPECT_GT(r0, r1);
  EXPECT_LT(std::abs(error), 1e-5);
}

}  // namespace
}  // namespace splatscope::tests
