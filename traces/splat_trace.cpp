#include "traces/splat_trace.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <utility>

#include "kernels/object_space_ewa/alpha_texture.h"
#include "kernels/object_space_ewa/programs.h"
#include "kernels/splat_programs.h"

namespace splatscope::traces {
namespace {

constexpr std::uint32_t kCorners = 4;           // of a surfel's quad
constexpr std::uint32_t kIndices = 6;           // two triangles
constexpr std::uint32_t kSurfelsADraw = 16384;  // as many quads as 16-bit indices reach

MemoryPlace place_of(const Splatting& settings) {
  return settings.vertex_memory == VertexMemory::agp ? MemoryPlace::agp : MemoryPlace::video;
}

Buffer vertex_buffer(std::span<const kernels::VertexField> fields, std::span<const Surfel> surfels,
                     std::span<const VertexWeights> weights, const Splatting& settings) {
  Buffer buffer;
  buffer.place = place_of(settings);
  const std::size_t bytes = kernels::vertex_bytes(fields);
  buffer.bytes.resize(surfels.size() * kCorners * bytes);
  std::byte* out = buffer.bytes.data();
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    const Tangents axes = tangents(surfels[k]);
    kernels::Surfel surfel{glm::dvec3(surfels[k].position), axes.s, axes.t, settings.sigma, 0,
                           glm::dvec3(surfels[k].color)};
    for (std::size_t i = 0; i < kCorners; ++i) {
      surfel.weight = weights[k][i];
      kernels::write_vertex(fields, {surfel, kernels::kQuadCorners[i], std::sqrt(2 * settings.cutoff)}, out);
      out += bytes;
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

// Along camera z the depth image moves as if the eye stood z_t further back; the program's own offset is then
// 0.
std::vector<Vec4> constants_of(const kernels::SplatProgram& program, kernels::View view,
                               const Splatting& settings) {
  const bool visibility =
      std::ranges::count(kernels::visibility_programs(), program.file, &kernels::SplatProgram::file) > 0;
  double along_ray = settings.depth_offset;
  if (visibility && settings.depth_offset_scheme == DepthOffsetScheme::camera_z) {
    view.object_to_camera[3].z += std::exchange(along_ray, 0);
  }
  return program.constants(view, settings.cutoff, along_ray);
}

// The draws of a pass: `program`, with its attributes and constants, for all surfels, in as many draws as
// 16-bit indices make of them.
void append_draws(Draw draw, const kernels::SplatProgram& program, const kernels::View& view,
                  const Splatting& settings, std::size_t surfels, Trace& trace) {
  draw.vertex_stride = kernels::vertex_bytes(program.fields);
  draw.attributes = kernels::attributes_of(program.fields);
  draw.constants = constants_of(program, view, settings);
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
    const glm::dvec2 y = reach * (2.0 * kernels::kQuadCorners[i] - 1.0);
    corners[i] = glm::dvec3(surfel.position) + y.x * axes.s + y.y * axes.t;
  }
  return corners;
}

int texture_length(const Splatting& settings) {
  return settings.texture_length > 0 ? settings.texture_length : kernels::optimal_length(settings.cutoff);
}

Trace splat_trace(std::span<const Surfel> surfels, const kernels::View& view, const Splatting& settings,
                  const SplatPass& pass) {
  Trace trace;
  trace.width = static_cast<std::uint32_t>(view.width);
  trace.height = static_cast<std::uint32_t>(view.height);
  trace.commands.emplace_back(Clear{});
  if (surfels.empty()) return trace;

  const auto at = [](auto programs, int place) { return programs[static_cast<std::size_t>(place)]; };
  const kernels::SplatProgram visibility = at(kernels::visibility_programs(), settings.visibility_program);
  const kernels::SplatProgram splats =
      pass.prefilter ? at(kernels::ewa_programs(), settings.ewa_program) : kernels::plain_program();
  trace.buffers.push_back(
      quad_indices(std::min<std::size_t>(surfels.size(), kSurfelsADraw), place_of(settings)));
  trace.buffers.push_back(vertex_buffer(visibility.fields, surfels, pass.weights, settings));
  // Passes with the same vertices share them.
  if (!std::ranges::equal(splats.fields, visibility.fields)) {
    trace.buffers.push_back(vertex_buffer(splats.fields, surfels, pass.weights, settings));
  }
  const auto shape = settings.circular_cutoff ? kernels::CutoffShape::circle : kernels::CutoffShape::square;
  trace.textures.push_back(kernels::alpha_texture(settings.cutoff, texture_length(settings), shape));
  trace.programs = {kernels::shader_text(visibility.file), kernels::shader_text(splats.file),
                    kernels::shader_text(pass.sum_weights ? kernels::kWeightedSplatPixelProgram
                                                          : kernels::kSplatPixelProgram)};

  Draw draw;
  draw.vertex_program = 0;
  draw.index_buffer = 0;
  draw.vertex_buffer = 1;
  draw.state.color_write = false;
  append_draws(draw, visibility, view, settings, surfels.size(), trace);

  draw.vertex_program = 1;
  draw.vertex_buffer = static_cast<std::uint32_t>(trace.buffers.size() - 1);
  draw.pixel_program = 2;
  draw.texture = 0;
  draw.state = {.depth_test = true, .depth_write = false, .color_write = true, .blend = true};
  draw.state.source_factor = pass.sum_weights ? BlendFactor::one : BlendFactor::src_alpha;
  draw.state.destination_factor = BlendFactor::one;
  append_draws(draw, splats, view, settings, surfels.size(), trace);
  return trace;
}

std::vector<Command> seen_from(const kernels::View& view, const Splatting& settings, const Trace& trace) {
  std::vector<Command> commands = trace.commands;
  for (Command& command : commands) {
    if (auto* draw = std::get_if<Draw>(&command)) {
      const kernels::SplatProgram& program =
          kernels::splat_program(trace.programs[draw->vertex_program].name);
      draw->constants = constants_of(program, view, settings);
    }
  }
  return commands;
}

}  // namespace splatscope::traces
