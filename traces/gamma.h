#pragma once

#include <span>
#include <vector>

#include "traces/scene.h"

namespace splatscope::traces {

inline constexpr double kPaperGamma = 0.73;  // Ren 2002, section 7.2: "works for most surfel models"

// The largest scale of the weights, up to the paper's, at which their sums hardly ever exceed 1: what
// `splatting.gamma = 0` stands for. The paper's is about the inverse of 1.355, the largest sum of a square
// grid whose radius h is the diagonal; where radii reach further, more splats overlap, 0.73 saturates the
// frame buffer, and the captured weights would all be the same. Found from the sums at the surfels themselves
// (10,000 of them, spread evenly over their order), in double precision; 1 in 100 may be larger.
double suitable_gamma(std::span<const Surfel> surfels, const Splatting& splatting);

// The sums of the filters r_j (Ren 2002, Eq. 1) at every `step`th surfel, in double precision: what a capture
// of weights measures, and whose inverse s_k is (7.1). Of the surfels about the asked one those count that a
// view along its normal shows with it: they face the eye, and neither lies behind the other by more than z_t.
std::vector<double> filter_sums(std::span<const Surfel> surfels, const Splatting& splatting,
                                std::size_t step);

}  // namespace splatscope::traces
