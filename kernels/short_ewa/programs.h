#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "kernels/view.h"
#include "model/command/commands.h"

// Short programs of the EWA filter (README.md) and how their registers are filled.
namespace splatscope::kernels {

inline constexpr std::string_view kPlaneProgram = "splat_plane.vs";
inline constexpr std::string_view kNormalProgram = "splat_normal.vs";
inline constexpr std::string_view kFacingProgram = "splat_facing.vs";

// Vertex inputs of splat_plane.vs and splat_facing.vs; v0 is o as for the others
// (object_space_ewa/programs.h).
enum PlaneInput : std::uint8_t {
  kPlaneInput = 1,            // float4: the normal n of unit length, and -n.o
  kScaledCornerInput = 3,     // float2: r y, with y of Eq. 14 and r = sigma h; z and w are read as 0 and 1
  kInverseVarianceInput = 4,  // float1: 1/r^2
  kWeightedColorInput = 5,    // float4: w_k, and s_k/(2 pi sigma^2)
  kTextureInput = 6           // short2: v, each 0 or 1
};

// Vertex inputs of splat_normal.vs; v0 is o, v5 is w_k as d3dcolor.
enum NormalInput : std::uint8_t {
  kNormalInput = 1,       // float3: n
  kShortCornerInput = 3,  // short2: v, each 0 or 1
  kDeviationInput = 4     // float2: r, and s_k/(2 pi sigma^2)
};

// Constants c0 to c8. c0..c2: rows of the object-to-camera matrix without its scale, the first two times eta.
// c3: eta^2 times the eye. c4: frustum. c5..c8: numbers; c8 holds sqrt(2 `cutoff`). `depth_offset` is not
// read.
std::vector<Vec4> plane_constants(const View& view, double cutoff, double depth_offset);

}  // namespace splatscope::kernels
