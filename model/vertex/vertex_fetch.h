#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "model/command/commands.h"
#include "model/vertex/vertex_program.h"

namespace splatscope::vertex {

// Bytes that one attribute of this format takes.
std::uint32_t size_of(VertexFormat format);

// What components that no fetch writes hold, in all lanes of `inputs` (bit n: v<n>): 0, 0, 0, 1.
void fill_defaults(InputBatch& out, unsigned inputs = 0xffff);

// The vertices `vertex_numbers` (at most kBatch) of a buffer with `stride` bytes a vertex into lanes 0, 1,
// ... of `out`: the components that each attribute's format has. d3dcolor is blue, green, red, alpha in
// memory and comes out as r g b a over 255; ubyte4, short2 and short4 are converted to floats as they are.
// The caller has checked that every attribute of every vertex lies within the buffer.
void fetch(std::span<const VertexAttribute> attributes, std::span<const std::byte> buffer,
           std::uint32_t stride, std::span<const std::uint32_t> vertex_numbers, InputBatch& out);

// The same; but inputs in which the vertices of each group (kGroup) agree go into a lane a group of `grouped`
// instead. Returns these inputs (bit n: v<n>), those that no attribute feeds among them; 0 where the vertices
// are no whole number of groups. Both batches have had the defaults of what is read filled in.
unsigned fetch_grouped(std::span<const VertexAttribute> attributes, std::span<const std::byte> buffer,
                       std::uint32_t stride, std::span<const std::uint32_t> vertex_numbers, InputBatch& out,
                       InputBatch& grouped);

}  // namespace splatscope::vertex
