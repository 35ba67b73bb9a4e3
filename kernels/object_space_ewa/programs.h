#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "kernels/view.h"
#include "model/command/load_program.h"

// The programs of object-space EWA splatting (README.md) and how their registers are filled.
namespace splatscope::kernels {

inline constexpr std::string_view kVisibilityProgram = "visibility.vs";
inline constexpr std::string_view kCornerVisibilityProgram = "visibility_corner.vs";
inline constexpr std::string_view kPlainProgram = "splat_plain.vs";
inline constexpr std::string_view kEwaProgram = "splat_ewa.vs";
inline constexpr std::string_view kSplatPixelProgram = "splat.ps";                   // blend SRC_ALPHA, ONE
inline constexpr std::string_view kWeightedSplatPixelProgram = "splat_weighted.ps";  // blend ONE, ONE

// A program by its file name. Throws ModelError where there is none of that name.
ShaderText shader_text(std::string_view name);
inline isa::Program load_program(std::string_view name) {
  return splatscope::load_program(shader_text(name));
}

// Vertex inputs, the same for the three vertex programs: v0 to v5. A surfel is four vertices that differ only
// in the corner; a quad's two triangles take them in the order (0,0), (1,0), (1,1), (0,1) or its reverse.
enum SurfelInput : std::uint8_t {
  kPositionInput = 0,  // float3, w = 1: o, object units
  kTangentSInput =
      1,  // float3: s times h; s and t of unit length, at right angles to each other and to the normal
  kTangentTInput = 2,  // float3: t times h
  kCornerInput = 3,    // float2: v, each 0 or 1; also the texture coordinates
  kFilterInput =
      4,           // float2: sigma (standard deviation of the reconstruction filter in units of h, > 0), s_k
  kColorInput = 5  // d3dcolor: w_k; its alpha is not read
};

// Constants c0 to c9, of which each program reads those it needs.
inline constexpr int kSplatConstantCount = 10;

// c0..c2: rows of the object-to-camera matrix. c3..c4: the frustum, near plane, z_t. c5: corners. c6..c9:
// eta, guards, corners and the least number over 0, of the EWA program. `cutoff` is c of Eq. 14 (the filter
// ends at sqrt(2c) standard deviations), > 0; `depth_offset` is z_t of section 5.1 in camera-space units.
std::vector<Vec4> splat_constants(const View& view, double cutoff, double depth_offset);

}  // namespace splatscope::kernels
