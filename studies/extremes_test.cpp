#include "studies/extremes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace splatscope::studies {
namespace {

Splatter splatter(std::string_view name) {
  for (const Splatter& one : splatters()) {
    if (one.name == name) return one;
  }
  ADD_FAILURE() << "no splatter " << name;
  return {};
}

ExtremeSweep sweep(std::string_view name) {
  for (const ExtremeSweep& one : extreme_sweeps()) {
    if (one.name.starts_with(name)) return one;
  }
  ADD_FAILURE() << "no sweep " << name;
  return {};
}

// Edge-on, q - t cancels: the printed formulas are wrong long before the program is.
TEST(Extremes, PrintedFormulasBreakBeforeTheProgram) {
  const ExtremeRow printed = sweep_row(sweep("cosine"), splatter("Appendix A as printed"), 100, 1);
  const ExtremeRow program = sweep_row(sweep("cosine"), splatter("paper, ieee"), 100, 1);
  ASSERT_FALSE(std::isnan(printed.over_1));
  EXPECT_TRUE(std::isnan(program.over_1) || program.over_1 < 0.1 * printed.over_1);
}

// p = 0 with B < 0: Sgn(Bp) mirrors the ellipse.
TEST(Extremes, ThePrintedSignMirrorsAnEllipse) {
  const ExtremeRow printed = sweep_row(sweep("turn towards p = 0"), splatter("Appendix A as printed"), 1, 1);
  EXPECT_FALSE(std::isnan(printed.over_10));
  for (const std::string_view name : {"paper, ieee", "paper, nv20", "facing, ieee"}) {
    EXPECT_TRUE(std::isnan(sweep_row(sweep("turn towards p = 0"), splatter(name), 1, 1).over_1)) << name;
  }
}

// Each guard costs slots and repairs something.
TEST(Extremes, GuardsRepairWhatTheyAreFor) {
  for (const Guard& guard : guards()) {
    SCOPED_TRACE(guard.name);
    const GuardRow row = guard_row(guard, Arithmetic::ieee, 300, 1);
    EXPECT_GT(row.slots, 0);
    EXPECT_EQ(row.with.not_finite, 0);
    EXPECT_GT(row.without.not_finite + row.without.too_wide, row.with.not_finite + row.with.too_wide);
  }
}

// A splatter whose error is the value of the sweep itself, in per mille.
TEST(Extremes, ARowSaysWhereAnErrorPassesEachBound) {
  ExtremeSweep errors = sweep("cosine");
  errors.values = {5, 50, 500, 5000};
  std::size_t point = 0;
  const Splatter telling{"telling", [&](const kernels::View&, std::span<const kernels::Surfel>) {
                           return ExtremeErrors{.deviation = errors.values[point++] / 1000, .weight = 0.001};
                         }};
  errors.surfel = [](const kernels::View&, double, std::mt19937&) { return kernels::Surfel{}; };
  const ExtremeRow row = sweep_row(errors, telling, 1, 1);
  EXPECT_EQ(row.errors, (std::vector<double>{0.005, 0.05, 0.5, 5}));
  EXPECT_EQ(row.over_1, 50);
  EXPECT_EQ(row.over_10, 500);
  EXPECT_EQ(row.over_all, 5000);
}

}  // namespace
}  // namespace splatscope::studies
