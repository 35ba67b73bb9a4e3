#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/command/commands.h"
#include "model/work/work.h"

// What tests of drawing make and compare.
namespace splatscope::testing {

template <typename Values>
Buffer buffer_of(const Values& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {MemoryPlace::video, {bytes.begin(), bytes.end()}};
}

inline std::vector<std::array<unsigned, 5>> listed(std::span<const QuadWork> quads) {
  std::vector<std::array<unsigned, 5>> all;
  for (const QuadWork& quad : quads)
    all.push_back({quad.x, quad.y, quad.covered, quad.passed, quad.texel_block_count});
  return all;
}

// One draw of triangles on a square frame of `size` pixels a side, of vertices that are positions x y z w.
template <typename Positions, typename Indices>
Trace positions_drawn(std::uint32_t size, const Positions& positions, const Indices& indices,
                      const ShaderText& program) {
  Trace trace;
  trace.width = trace.height = size;
  trace.buffers = {buffer_of(positions), buffer_of(indices)};
  trace.programs = {program};
  Draw draw;
  draw.vertex_stride = 16;
  draw.attributes = {{0, VertexFormat::float4, 0}};
  draw.index_buffer = 1;
  draw.index_count = static_cast<std::uint32_t>(std::size(indices));
  trace.commands = {draw};
  return trace;
}

// One draw of rectangles, each over all of a square frame of `size` pixels a side.
inline Trace rectangles(std::uint32_t size, std::uint32_t count) {
  std::vector<float> vertices;
  std::vector<std::uint16_t> indices;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (const float corner : {-1.0f, 1.0f})
      for (const float value : {corner, -1.0f, 0.5f, 1.0f, corner, 1.0f, 0.5f, 1.0f})
        vertices.push_back(value);
    for (const unsigned corner : {0u, 1u, 2u, 2u, 1u, 3u})
      indices.push_back(static_cast<std::uint16_t>(4 * i + corner));
  }
  return positions_drawn(size, vertices, indices, {"plain.vs", "vs_1_1\nmov oPos, v0\nmov oD0, v0\n"});
}

}  // namespace splatscope::testing
