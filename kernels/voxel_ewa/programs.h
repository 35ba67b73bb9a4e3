#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <string_view>
#include <vector>

#include "kernels/view.h"
#include "model/command/commands.h"

// EWA volume splatting on the machine (README.md): programs, and how their registers are filled.
namespace splatscope::kernels {

inline constexpr std::string_view kVoxelGridProgram = "voxel_grid.vs";  // V in the constants
inline constexpr std::string_view kVoxelProgram = "voxel.vs";           // V in the vertex
inline constexpr std::string_view kSheetProgram = "sheet.vs";
inline constexpr std::string_view kSheetPixelProgram = "sheet.ps";  // blend ONE, INV_SRC_ALPHA

// Vertex inputs of both voxel programs. A voxel is four vertices that differ only in the corner.
enum VoxelInput : std::uint8_t {
  kVoxelPositionInput = 0,  // w = 1: in units of the vertex buffer
  kVoxelCornerInput = 1,    // short2: y, each -1 or 1
  kVoxelColorInput = 2,     // r g b, and opacity in units of the draw
  kVoxelVarianceInput = 3   // to 5, of voxel.vs: float3 each, the rows of V, object units squared
};
// Of sheet.vs: v0, float3: clip coordinates; v1, float2: texture coordinates; c0 is the diffuse colour.

// Constants c0 to c9 of a perspective view. `to_object`: of a vertex's position. `variance`: V of all voxels
// of voxel_grid.vs, object units squared; null for voxel.vs. A splat ends at the radial index r = `cutoff`.
// The diffuse alpha is the vertex's times `unit` times the footprint's peak (reference/volume/footprint.h).
std::vector<Vec4> voxel_constants(const View& view, const glm::dmat4& to_object, const glm::dmat3* variance,
                                  double cutoff, double unit);

// Opacity and colour of a voxel's fragment: for blending with ONE, ONE. `steps`/255 is the opacity of a
// diffuse alpha of 1: in 8 bits most footprints would have only a few steps of their own.
ShaderText voxel_pixel_program(int steps);

}  // namespace splatscope::kernels
