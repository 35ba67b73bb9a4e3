#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

// What a draw, or a part of it, gave each fixed-function stage to do, in order; the timing simulation moves
// exactly this. It holds no colour and no cycle.
namespace splatscope {

enum class TriangleOutcome : std::uint8_t {
  drawn,
  no_coverage,      // no pixel centre inside (degenerate ones too)
  outside_frustum,  // wholly outside one clip plane
  behind_near,      // wholly before the near plane or behind the eye
  not_finite,       // a NaN or INF position: dropped, and counted
  back_facing       // dropped by the draw's cull mode
};

struct TriangleWork {
  std::uint32_t quad_count = 0;    // 2x2 quads with coverage, in raster order
  std::uint32_t quads_passed = 0;  // of these, with a pixel that passed the depth test
  std::uint32_t tile_count = 0;    // 8x8-pixel tiles the rasteriser visited
  std::uint8_t new_vertices = 0;   // 0..3 not found in the post-transform FIFO: they are shaded first
  std::uint8_t pieces = 1;         // triangles after clipping and culling; 0 when rejected
  TriangleOutcome outcome = TriangleOutcome::drawn;
};

// Pixels of a quad, bit = (y&1)*2 + (x&1).
struct QuadWork {
  std::uint16_t x = 0, y = 0;          // pixel / 2
  std::uint8_t covered = 0;            // 4-bit mask
  std::uint8_t passed = 0;             // subset of `covered` that passed the depth test (all where it is off)
  std::uint8_t texel_block_count = 0;  // distinct texel blocks of the passed pixels: 0..4
};

// 4x4 texels (16 bytes of an A8 texture), numbered by rows of blocks.
inline constexpr std::uint32_t kTexelBlockEdge = 4;
inline constexpr std::uint32_t kTexelBlockBytes = kTexelBlockEdge * kTexelBlockEdge;

// 4x4 pixels of the frame, numbered by rows: what a cache line of it holds.
inline constexpr std::uint32_t kFrameTileEdge = 4;
// Along a side of so many pixels; the last may lie in part beyond it.
constexpr std::uint32_t frame_tiles(std::uint32_t pixels) {
  return (pixels + kFrameTileEdge - 1) / kFrameTileEdge;
}

// A tile in which a sampled triangle covers pixels, and where all depth is still that of the last clear.
struct ClearTile {
  std::uint32_t triangle = 0;
  std::uint32_t tile = 0;
};

// Estimates look at the quads of some triangles only: of the first run of a draw, and of each so many runs
// behind it. With runs half as long, the caches hold too little of what comes before.
inline constexpr std::size_t kSampledRun = 128;
// By the triangles of a frame: all of a small one, one run in 32 of a large one; a power of two.
constexpr std::uint32_t sampled_runs_apart(std::uint64_t triangles) {
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(std::bit_floor(triangles / 8192), 1, 32));
}

struct DrawWork {
  std::uint32_t command = 0;                   // its place in Trace::commands
  std::vector<std::uint32_t> shaded_vertices;  // vertex numbers (base_vertex added) in the order of shading
  std::vector<TriangleWork> triangles;         // as indexed
  std::vector<QuadWork> quads;                 // of all triangles in order
  std::vector<std::uint32_t> texel_blocks;     // of all quads in order
  std::vector<ClearTile> clear_tiles;          // by triangle
  std::uint32_t sampled_runs_apart = 1;
  // Whether only samples of it were recorded: no shaded vertices, quads and texel blocks of the sampled
  // triangles.
  bool samples_only = false;

  // The part of the same draw that comes next.
  void append(const DrawWork& part) {
    const auto behind = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
    behind(shaded_vertices, part.shaded_vertices);
    behind(triangles, part.triangles);
    behind(quads, part.quads);
    behind(texel_blocks, part.texel_blocks);
    behind(clear_tiles, part.clear_tiles);
  }

  bool is_sampled(std::size_t triangle) const {
    return (triangle / kSampledRun & (sampled_runs_apart - 1)) == 0;
  }
  // The first triangle behind this one whose quads, if it has any, are in the record.
  std::size_t next_recorded(std::size_t triangle) const {
    const std::size_t next = triangle + 1, apart = kSampledRun * sampled_runs_apart;
    return !samples_only || is_sampled(next) ? next : (next / apart + 1) * apart;
  }
};

}  // namespace splatscope
