#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/view.h"
#include "model/command/commands.h"
#include "traces/scene.h"

namespace splatscope::traces {

// Vertices of the quad of a splat or voxel, and indices: of two triangles.
inline constexpr std::uint32_t kQuadVertices = 4, kQuadIndices = 6;

// s_k at the vertices of a surfel's quad, in the order of its corners: (0,0), (1,0), (1,1), (0,1).
using VertexWeights = std::array<float, 4>;

// One weight for all four.
constexpr VertexWeights equal_weights(double weight) {
  const auto w = static_cast<float>(weight);
  return {w, w, w, w};
}

// The vertices of the quad that a surfel is splatted with where there is no prefilter, in the same order:
// o +- sqrt(2c) sigma (s, t) (Ren 2002, Eq. 14 and 12).
std::array<glm::dvec3, 4> quad_corners(const Surfel& surfel, const Splatting& settings);

// Texels along an edge of the alpha texture.
int texture_length(const Splatting& settings);

// How the second pass splats.
struct SplatPass {
  bool prefilter = true;     // EWA; false: the reconstruction filter alone
  bool sum_weights = false;  // true: the alpha channel sums the weights; false: it is left to the blend unit
  bool normalize_on_host = false;  // each frame, after its splats
  bool refine = false;  // the last frame once more, with SurfelBuffer::still_weight, normalised on the host
};

// At most this many surfels in a draw: as many quads as 16-bit indices reach.
inline constexpr std::size_t kSurfelsADraw = 16384;

// Surfels that share a vertex buffer, or one for each pass where the passes' vertices differ.
struct SurfelBuffer {
  std::span<const Surfel> surfels;
  std::span<const VertexWeights> weights;  // of each
  double still_weight = 0;                 // of all in the frame that refines; read only where there is one
};

// Some of a buffer's surfels, to be drawn in one call of each pass.
struct DrawnRange {
  std::uint32_t buffer = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;  // at most kSurfelsADraw
  double depth_offset = 0;  // z_t, object units
};

// The scene's camera and frame as the programs need them.
kernels::View view_of(const Camera& camera, const FrameSize& frame);

// The orthogonal tangents of a surfel, scaled by its radius h: the axes of its parameterisation.
struct Tangents {
  glm::dvec3 s, t;
};
Tangents tangents(const Surfel& surfel);

// The 16-bit indices of so many quads, as two triangles each, whose four vertices follow each other.
Buffer quad_indices(std::size_t quads);

// Buffers, programs and draws of the two passes of Ren 2002, section 5: for each of `frames` clear,
// visibility and splats of its ranges, in their order. The frame that refines the last one has vertices of
// its own, as the weights lie in the vertices: those of ewa-per-pixel. Four vertices a surfel, six 16-bit
// indices a surfel shared by all draws. Buffers lie where `settings.vertex_memory` says: `automatic` puts
// them into video memory in turn until `settings.video_megabytes` are full. Lengths are those of object
// space, or a power of two times them where the program needs it (`SplatProgram::near_in_sums`).
Trace splat_trace(std::span<const SurfelBuffer> buffers, std::span<const std::vector<DrawnRange>> frames,
                  const kernels::View& view, const Splatting& settings, const SplatPass& pass);

// The same for one frame of all surfels, in one buffer.
Trace splat_trace(const SurfelBuffer& surfels, const kernels::View& view, const Splatting& settings,
                  const SplatPass& pass);

// The commands of a splat trace as they are for another view of the same size. Not where the trace has a unit
// of length of its own.
std::vector<Command> seen_from(const kernels::View& view, const Splatting& settings, const Trace& trace);

}  // namespace splatscope::traces
