#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/reference/filter_value.h"
#include "kernels/reference/splat_sums.h"
#include "kernels/reference/surfel_filter.h"
#include "kernels/view.h"

// EWA surface splatting on the host, in double precision: the yardstick for the machine's pictures.
namespace splatscope::kernels {

// How a pixel's centre x is taken back to the surfel's plane.
enum class ScreenMap : std::uint8_t {
  affine,      // m_k: the screen-space filter of Ren 2002, Eq. 5
  perspective  // m itself: the object-space filter of Eq. 8, as a polygon in the surfel's plane is projected
};

struct ScreenSpaceSettings {
  ReferenceSettings filter;
  ScreenMap map = ScreenMap::affine;
  double depth_offset = 0;       // z_t of section 5.1, camera-space units, >= 0; INFINITY: nothing is hidden
  bool cull_back_faces = false;  // surfels whose normal s x t points away from the eye are left out
};

struct ScreenSpacePicture : SplatSums {
  // Camera z of the nearest opaque quad at every pixel's centre, before it is moved back by z_t; INFINITY
  // where there is none.
  std::vector<double> depth;
  double depth_offset = 0;  // z_t that it was drawn with
  std::size_t skipped = 0;  // surfels without a filter (surfel_filter)
  std::size_t culled = 0;   // surfels that face away
};

// Visibility and sums of Ren 2002, section 5, at exact pixel centres. Every surfel is an opaque quad o +- s
// +- t; the nearest of them under a pixel's ray, moved away from the eye by z_t along that ray, is the
// pixel's depth. A splat adds s_k w_k rho_k(x) where its plane under the ray is no further. Both count
// between near and far plane only. Several threads; the same bits for any number of them: each pixel adds in
// the surfels' order.
ScreenSpacePicture screen_space_ewa(const View& view, std::span<const Surfel> surfels,
                                    const ScreenSpaceSettings& settings);

}  // namespace splatscope::kernels
