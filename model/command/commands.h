#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "model/number/blend.h"

// What a GPU of 2002 is told: buffers, textures, programs, and a list of commands. The trace file is this
// structure on disk. Nothing here knows a surfel.
namespace splatscope {

using Vec4 = std::array<float, 4>;

enum class MemoryPlace : std::uint8_t { video, agp };

enum class VertexFormat : std::uint8_t { float1, float2, float3, float4, d3dcolor, ubyte4, short2, short4 };

struct VertexAttribute {
  std::uint8_t input = 0;  // v0..v15
  VertexFormat format = VertexFormat::float3;
  std::uint16_t offset = 0;  // bytes from the start of a vertex

  bool operator==(const VertexAttribute&) const = default;
};

// Bytes of vertices or of 16-bit indices.
struct Buffer {
  MemoryPlace place = MemoryPlace::video;
  std::vector<std::byte> bytes;
};

// One channel of 8-bit alpha (D3DFMT_A8), rows from v = 0, width*height texels, clamped to the edge. Studies
// also make textures of other depths, which no trace file holds: a texel is a whole number of
// 1/(2^bits - 1), in one byte up to 8 bits, else in two, the low one first.
struct Texture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> texels;
  int bits = 8;  // 1 to 16
};

struct ShaderText {
  std::string name;  // "splat_ewa.vs"
  std::string text;  // assembly, vs_1_1 or ps_1_x
};

// Which triangles are dropped: those whose corners run this way round in the window, y down (D3DRS_CULLMODE).
enum class CullMode : std::uint8_t { none, clockwise, counter_clockwise };

// Fixed-function state of a draw.
struct DrawState {
  bool depth_test = true;  // passes where depth <= stored depth
  bool depth_write = true;
  bool color_write = true;
  bool blend = false;  // out = src*source_factor + dst*destination_factor
  BlendFactor source_factor = BlendFactor::one;
  BlendFactor destination_factor = BlendFactor::zero;
  CullMode cull = CullMode::none;
};

// Indexed triangle list. Indices into `programs`, `buffers`, `textures` of the trace.
struct Draw {
  std::uint32_t vertex_program = 0;
  std::optional<std::uint32_t> pixel_program;  // absent: the interpolated diffuse colour
  std::optional<std::uint32_t> texture;        // of stage 0
  // Render to texture: where the draw writes, 0 the frame, n > 0 the off-screen surface n, which has no
  // depth; and an off-screen surface other than the target that stage 0 samples in place of a texture: the
  // nearest pixel, all four channels.
  std::uint32_t target = 0;
  std::optional<std::uint32_t> source;
  std::uint32_t vertex_buffer = 0;
  std::uint32_t vertex_stride = 0;  // bytes
  std::vector<VertexAttribute> attributes;
  std::uint32_t base_vertex = 0;  // added to each index (D3D8 SetIndices)
  std::uint32_t index_buffer = 0;
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;  // a multiple of 3
  std::vector<Vec4> constants;    // c0, c1, ...: at most 96, the rest are 0
  DrawState state;
};

// What a draw has to do with: it goes past the units of the rest, so that leaving them out changes nothing.
inline bool uses_depth(const Draw& draw) {
  return draw.state.depth_test || draw.state.depth_write;
}
// Whether its pixel program samples the texture too, its program tells (`sim/draw_jobs.h`).
inline bool binds_texture(const Draw& draw) {
  return draw.state.color_write && (draw.texture.has_value() || draw.source.has_value());
}

// Of the frame; a draw clears an off-screen surface.
struct Clear {
  Vec4 color{};        // r g b a
  float depth = 1.0f;  // 0..1
};

// The host reads the frame buffer over the bus, divides r, g and b by alpha (the summed weights; 0 stays 0),
// and writes it back: per-pixel normalisation, Ren 2002, section 7.
struct NormalizeOnHost {};

// Ends a frame: the picture at this point is shown. The surfaces keep what they hold.
struct Present {};

using Command = std::variant<Clear, Draw, NormalizeOnHost, Present>;

// Pixels; ours: more than the machines of 2002 can show.
inline constexpr int kMostFrameEdge = 4096;

// Frames of `width` x `height` pixels, at most kMostFrameEdge each.
struct Trace {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t surfaces = 0;  // off-screen ones, of the frame's size and format; 0 before the first draw
  std::vector<Buffer> buffers;
  std::vector<Texture> textures;
  std::vector<ShaderText> programs;
  std::vector<Command> commands;
};

// How many of the commands are done at the end of each frame. The end of the trace ends a frame too where
// something follows the last Present, or there is none: at least one frame.
std::vector<std::size_t> frame_ends(const Trace& trace);

}  // namespace splatscope
