#pragma once

#include <span>
#include <vector>

#include "studies/frame_cost.h"
#include "studies/study.h"

namespace splatscope::studies {

// What a frame of so many surfels costs the host. Four pixels a surfel, as in Table 1. Memory is that beyond
// what the process held before; 0: the system does not tell.
struct GrowthRow {
  int surfels = 0;
  double trace_megabytes = 0;  // while it is recorded
  FrameCost functional, sampled, cycle;
};

// Square planes of `sides` surfels along an edge.
std::vector<GrowthRow> growth_rows(std::span<const int> sides, const Progress& progress = {});

// The exponent of a power law through the points, all above 0: the slope of their logarithms' least-squares
// line.
double log_log_slope(const std::vector<double>& x, const std::vector<double>& y);

// fixed + linear * x, both not below 0: the line through the points, all above 0 and at two x or more, that
// is off by the least sum of squared fractions of them. `worst`: the largest of these fractions.
struct FixedAndLinear {
  double fixed = 0, linear = 0, worst = 0;
};
FixedAndLinear fixed_and_linear(const std::vector<double>& x, const std::vector<double>& y);

// A table, a plot and figures. A measure that is not above 0 in every row, such as memory of which the system
// does not tell, has no power law and is left out.
void add_growth_report(Findings& findings, std::span<const GrowthRow> rows);

// The study: from 10,000 to a million surfels.
void study_growth(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
