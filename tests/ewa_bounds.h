#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "kernels/reference/filter_value.h"
#include "kernels/reference/splat_sums.h"
#include "kernels/reference/surfel_filter.h"
#include "kernels/view.h"
#include "model/output/frame.h"

// What a machine may draw of a single visible surface (Ren 2002, Eq. 8, in double precision), as far as the
// equations leave open on which side of a pixel's centre a cutoff or an edge falls.
namespace splatscope::tests {

// What a picture is given leave for.
struct Leave {
  // A splat whose cutoff passes a pixel's centre this close, in units of y, may count there or not. A texel
  // of an alpha texture of size len is 2 sqrt(2c)/len.
  double cutoff_tolerance = 0;
  // The same for the edges of its parallelogram, which a rasteriser moves to its grid: they touch a circular
  // cutoff at four points. With the prefilter, one pixel moves y by at most 1.
  double edge_tolerance = 0;
  // Size of an 8-bit alpha texture whose texel nearest to y is the splat's value, where y is known to
  // cutoff_tolerance; 0: the value is exp(-y.y/2).
  int texture_length = 0;
};

// The values, from `low` to `high`, that a splat may have at y: 0 and the Gaussian's where a cutoff or an
// edge is within its tolerance, or those of every texel that may be the nearest.
struct FilterRange {
  double low = 0;
  double high = 0;
};
FilterRange filter_range(const kernels::ReferenceSettings& filter, const Leave& leave, const glm::dvec2& y);

enum class Coverage : std::uint8_t { none, uncertain, certain };  // uncertain: only by splats that may be 0

// Of every pixel: exact bounds, each channel by itself, of the normalised picture over every choice of the
// splats' values in their ranges, where at least one splat counts; 0 where none can.
struct EwaBounds {
  std::vector<glm::dvec3> lowest;
  std::vector<glm::dvec3> highest;
  std::vector<Coverage> coverage;
};
EwaBounds ewa_bounds(const kernels::View& view, std::span<const kernels::Surfel> surfels,
                     const kernels::ReferenceSettings& filter, const Leave& leave);

struct Agreement {
  std::size_t pixels = 0;   // with splats that certainly count
  std::size_t outside = 0;  // of these: further than 0.5/255 from the bounds
  double worst = 0;         // distance from the bounds, in 1/255
};

// How far a picture is from its bounds: on the surface (as for studies::psnr), and on the fringe of splats
// beyond it, where so few overlap that the rounding of the 8-bit texture shows.
struct SurfaceAgreement {
  Agreement surface, fringe;
};
SurfaceAgreement agreement(const Frame& frame, const kernels::SplatSums& reference, const EwaBounds& bounds);

}  // namespace splatscope::tests
