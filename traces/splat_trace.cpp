#include "traces/splat_trace.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "kernels/object_space_ewa/alpha_texture.h"
#include "kernels/object_space_ewa/programs.h"

namespace splatscope::traces {
namespace {

// A vertex as it lies in memory.
struct Vertex {
  float position[3];
  float tangent_s[3];
  float tangent_t[3];
  float corner[2];
  float filter[2];        // sigma, s_k
  std::uint8_t color[4];  // b g r a
};
static_assert(sizeof(Vertex) == 56);

constexpr std::uint32_t kCorners = 4;  // of a surfel's quad
constexpr float kCornerPlaces[kCorners][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
constexpr std::uint32_t kIndices = 6;           // two triangles
constexpr std::uint32_t kSurfelsADraw = 16384;  // as many quads as 16-bit indices reach

const std::vector<VertexAttribute> kAttributes = {
    {kernels::kPositionInput, VertexFormat::float3, offsetof(Vertex, position)},
    {kernels::kTangentSInput, VertexFormat::float3, offsetof(Vertex, tangent_s)},
    {kernels::kTangentTInput, VertexFormat::float3, offsetof(Vertex, tangent_t)},
    {kernels::kCornerInput, VertexFormat::float2, offsetof(Vertex, corner)},
    {kernels::kFilterInput, VertexFormat::float2, offsetof(Vertex, filter)},
    {kernels::kColorInput, VertexFormat::d3dcolor, offsetof(Vertex, color)}};

void store(const glm::dvec3& from, float (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}

std::uint8_t color_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

Buffer vertex_buffer(std::span<const Surfel> surfels, std::span<const VertexWeights> weights,
                     const Splatting& settings) {
  Buffer buffer;
  buffer.place = settings.vertex_memory == VertexMemory::agp ? MemoryPlace::agp : MemoryPlace::video;
  buffer.bytes.resize(surfels.size() * kCorners * sizeof(Vertex));
  std::byte* out = buffer.bytes.data();
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    const Surfel& surfel = surfels[k];
    const Tangents axes = tangents(surfel);
    Vertex vertex{};
    store(surfel.position, vertex.position);
    store(axes.s, vertex.tangent_s);
    store(axes.t, vertex.tangent_t);
    vertex.filter[0] = static_cast<float>(settings.sigma);
    for (int i = 0; i < 3; ++i) vertex.color[i] = color_byte(surfel.color[2 - i]);
    vertex.color[3] = 255;
    for (std::size_t i = 0; i < kCorners; ++i) {
      std::ranges::copy(kCornerPlaces[i], vertex.corner);
      vertex.filter[1] = weights[k][i];
      std::memcpy(out, &vertex, sizeof vertex);
      out += sizeof vertex;
    }
  }
  return buffer;
}

Buffer quad_indices(std::size_t quads, MemoryPlace place) {
  constexpr std::uint16_t order[kIndices] = {0, 1, 2, 0, 2, 3};
  Buffer buffer;
  buffer.place = place;
  buffer.bytes.resize(quads * kIndices * sizeof(std::uint16_t));
  for (std::size_t i = 0; i < quads * kIndices; ++i) {
    const auto index = static_cast<std::uint16_t>(i / kIndices * kCorners + order[i % kIndices]);
    std::memcpy(buffer.bytes.data() + i * sizeof index, &index, sizeof index);
  }
  return buffer;
}

// `draw` for all surfels, as many draws as 16-bit indices make of them.
void append_draws(Draw draw, std::size_t surfels, Trace& trace) {
  for (std::size_t first = 0; first < surfels; first += kSurfelsADraw) {
    draw.base_vertex = static_cast<std::uint32_t>(first * kCorners);
    draw.index_count =
        static_cast<std::uint32_t>(std::min<std::size_t>(kSurfelsADraw, surfels - first) * kIndices);
    trace.commands.emplace_back(draw);
  }
}

}  // namespace

kernels::View view_of(const Camera& camera, const Frame& frame) {
  return kernels::look_at(camera.eye, camera.target, camera.up, camera.fov_y_degrees, frame.width,
                          frame.height, camera.near, camera.far);
}

Tangents tangents(const Surfel& surfel) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(surfel.normal));
  // The axis furthest from the normal keeps the cross product well away from zero.
  const glm::dvec3 size = glm::abs(normal);
  const glm::dvec3 axis = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                          : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                               : glm::dvec3(0, 0, 1);
  const glm::dvec3 s = glm::normalize(glm::cross(axis, normal));
  return {double{surfel.radius} * s, double{surfel.radius} * glm::cross(normal, s)};
}

std::array<glm::dvec3, 4> quad_corners(const Surfel& surfel, const Splatting& settings) {
  const Tangents axes = tangents(surfel);
  const double reach = std::sqrt(2 * settings.cutoff) * settings.sigma;
  std::array<glm::dvec3, 4> corners;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const glm::dvec2 y = reach * (2.0 * glm::dvec2(kCornerPlaces[i][0], kCornerPlaces[i][1]) - 1.0);
    corners[i] = glm::dvec3(surfel.position) + y.x * axes.s + y.y * axes.t;
  }
  return corners;
}

Trace splat_trace(std::span<const Surfel> surfels, const kernels::View& view, const Splatting& settings,
                  const SplatPass& pass) {
  Trace trace;
  trace.width = static_cast<std::uint32_t>(view.width);
  trace.height = static_cast<std::uint32_t>(view.height);
  trace.commands.emplace_back(Clear{});
  if (surfels.empty()) return trace;

  trace.buffers.push_back(vertex_buffer(surfels, pass.weights, settings));
  trace.buffers.push_back(
      quad_indices(std::min<std::size_t>(surfels.size(), kSurfelsADraw), trace.buffers[0].place));
  const auto shape = settings.circular_cutoff ? kernels::CutoffShape::circle : kernels::CutoffShape::square;
  trace.textures.push_back(
      kernels::alpha_texture(settings.cutoff, kernels::optimal_length(settings.cutoff), shape));
  trace.programs = {
      kernels::object_space_ewa_program(kernels::kVisibilityProgram),
      kernels::object_space_ewa_program(pass.prefilter ? kernels::kEwaProgram : kernels::kPlainProgram),
      kernels::object_space_ewa_program(pass.sum_weights ? kernels::kWeightedSplatPixelProgram
                                                         : kernels::kSplatPixelProgram)};

  Draw draw;
  draw.vertex_program = 0;
  draw.vertex_buffer = 0;
  draw.vertex_stride = sizeof(Vertex);
  draw.attributes = kAttributes;
  draw.index_buffer = 1;
  draw.constants = kernels::splat_constants(view, settings.cutoff, settings.depth_offset);
  draw.state.color_write = false;
  append_draws(draw, surfels.size(), trace);

  draw.vertex_program = 1;
  draw.pixel_program = 2;
  draw.texture = 0;
  draw.state = {.depth_test = true, .depth_write = false, .color_write = true, .blend = true};
  draw.state.source_factor = pass.sum_weights ? BlendFactor::one : BlendFactor::src_alpha;
  draw.state.destination_factor = BlendFactor::one;
  append_draws(draw, surfels.size(), trace);
  return trace;
}

std::vector<Command> seen_from(const kernels::View& view, const Splatting& settings, const Trace& trace) {
  std::vector<Command> commands = trace.commands;
  for (Command& command : commands) {
    if (auto* draw = std::get_if<Draw>(&command)) {
      draw->constants = kernels::splat_constants(view, settings.cutoff, settings.depth_offset);
    }
  }
  return commands;
}

}  // namespace splatscope::traces
