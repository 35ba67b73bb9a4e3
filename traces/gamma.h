#pragma once

#include <span>
#include <vector>

#include "traces/scene.h"

namespace splatscope::traces {

inline constexpr double kPaperGamma = 0.73;  // Ren 2002, section 7.2: "works for most surfel models"

// The largest scale of the weights, up to the paper's, at which their sums hardly ever exceed 1: what
// `splatting.gamma = 0` stands for. The paper's is about the inverse of 1.355, the largest sum of a square
// grid whose radius h is the diagonal; where radii or the cutoff reach further, more splats overlap, 0.73
// saturates the frame buffer, and the captured weights would all be the same. Found from the sums at up to
// 10,000 places on the surface, at and between surfels spread evenly over their order, in double precision; 1
// in 100 may be larger.
double suitable_gamma(std::span<const Surfel> surfels, const Splatting& splatting);

// The sums of the filters r_j (Ren 2002, Eq. 1), in double precision, at the positions of `asked`: at the
// surfels themselves what a capture of weights measures, and whose inverse s_k is (7.1). Those surfels count
// that a view along the normal of the asked one shows with it: they face the eye, and neither lies behind the
// other by more than z_t. The same for any number of threads.
std::vector<double> filter_sums(std::span<const Surfel> surfels, const Splatting& splatting,
                                std::span<const Surfel> asked);

}  // namespace splatscope::traces
