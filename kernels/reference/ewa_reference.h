#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "kernels/reference/filter_value.h"
#include "kernels/reference/splat_sums.h"
#include "kernels/reference/surfel_filter.h"
#include "kernels/view.h"

// The picture of Ren 2002, Eq. 8, in double precision. A single visible surface is assumed: every surfel
// counts, none hides another (a plane, or the surfels that passed a depth test elsewhere).
namespace splatscope::kernels {

enum class Coverage : std::uint8_t { none, uncertain, certain };  // uncertain: only by splats that may be 0

// No tolerance is applied to the sums.
struct ReferencePicture : SplatSums {
  // Exact bounds, each channel by itself, of the normalised picture over every choice of the splats' values
  // in their ranges (filter_range), where at least one splat counts; 0 where none can.
  std::vector<glm::dvec3> lowest;
  std::vector<glm::dvec3> highest;
  std::vector<Coverage> coverage;
  std::size_t skipped = 0;  // surfels without a filter (surfel_filter)
};

// m is the perspective map itself: the ray of a pixel's centre meets the surfel's plane at m^-1(x), and
// counts where that lies within near and far plane. The weight is s_k/(2 pi r0 r1) exp(-y.y/2).
ReferencePicture ewa_reference(const View& view, std::span<const Surfel> surfels,
                               const ReferenceSettings& settings);

}  // namespace splatscope::kernels
