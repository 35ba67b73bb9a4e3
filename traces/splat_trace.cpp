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

// What lengths are multiplied by. A program that adds 1 to -1/near loses of the depth what floats lose of
// that sum: it is given a unit of length in which `near` is 1 to 2, where it is further. A power of two:
// nothing else changes by it, not a bit.
double unit_of(const kernels::SplatProgram& program, const kernels::View& view) {
  return program.near_in_sums && view.near_plane >= 2 ? std::ldexp(1.0, -std::ilogb(view.near_plane)) : 1;
}

kernels::View in_unit(kernels::View view, double unit) {
  view.object_to_camera[3] *= glm::dvec4(unit, unit, unit, 1);
  view.near_plane *= unit;
  view.far_plane *= unit;
  return view;
}

// Of the second pass.
const kernels::SplatProgram& splat_program(const Splatting& settings, const SplatPass& pass) {
  return pass.prefilter ? kernels::ewa_program(settings.ewa_program) : kernels::plain_program();
}

// Of a surfel, in pixels at its centre, or at the near plane before it: larger ones are drawn of this size,
// which covers any frame as well. Fourth powers of it appear in the EWA program, and must be finite floats.
constexpr double kLargestRadius = 1e9;

// `camera_scale`: units of the camera space in one of the object space.
float largest_radius(const kernels::View& view, double camera_scale, const glm::dvec3& center) {
  const double z = std::max(view.near_plane, view.camera_space(center).z);
  return static_cast<float>(kLargestRadius * z / (view.eta * camera_scale));
}

// Which corner of the program's quad lies about where each corner of o +- s +- t does, and so is to have its
// weight. The quad winds as o +- s +- t does in this view: culling by the winding goes by the surfel's
// normal.
std::array<std::size_t, kQuadVertices> corner_places(const kernels::SplatProgram& program,
                                                     const kernels::View& view,
                                                     const kernels::Surfel& surfel) {
  if (!program.screen_corners) return {0, 1, 2, 3};
  const glm::dvec3 o = view.camera_space(surfel.position);
  const auto on_screen = [&](const glm::dvec3& axis) {  // times z^2
    const glm::dvec3 d = view.camera_direction(axis);
    return glm::dvec2(d) * o.z - glm::dvec2(o) * d.z;
  };
  // But for the low-pass filter the lower factor L of [s t] [s t]^T is [s t] Q with Q orthogonal. L's first
  // row is (l11, 0), so Q's first column lies along the first row of [s t]. Corner (-1, -1) is drawn as Q^-1
  // (-1, -1).
  const glm::dvec2 s = on_screen(surfel.tangent_s), t = on_screen(surfel.tangent_t);
  const bool mirrored = s.x * t.y < t.x * s.y;
  const bool right = s.x + t.x < 0, up = mirrored ? s.x > t.x : s.x < t.x;
  const std::size_t first = up ? (right ? 2 : 3) : (right ? 1 : 0);
  const std::size_t step = mirrored ? kQuadVertices - 1 : 1;
  return {first, (first + step) % kQuadVertices, (first + 2) % kQuadVertices,
          (first + 3 * step) % kQuadVertices};
}

Buffer vertex_buffer(const kernels::SplatProgram& program, const SurfelBuffer& from,
                     const kernels::View& view, const Splatting& settings) {
  const std::span surfels = from.surfels;
  const std::span weights = from.weights;
  Buffer buffer;
  const std::size_t bytes = kernels::vertex_bytes(program.fields);
  buffer.bytes.resize(surfels.size() * kQuadVertices * bytes);
  std::byte* out = buffer.bytes.data();
  const double camera_scale = glm::length(glm::dvec3(view.object_to_camera[0]));
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    Surfel drawn = surfels[k];
    drawn.radius = std::min(drawn.radius, largest_radius(view, camera_scale, glm::dvec3(drawn.position)));
    const Tangents axes = tangents(drawn);
    kernels::Surfel surfel{glm::dvec3(surfels[k].position), axes.s, axes.t, settings.sigma, 0,
                           glm::dvec3(surfels[k].color)};
    const std::array<std::size_t, kQuadVertices> places = corner_places(program, view, surfel);
    for (std::size_t i = 0; i < kQuadVertices; ++i) {
      surfel.weight = weights[k][i];
      kernels::write_vertex(program.fields,
                            {surfel, kernels::kQuadCorners[places[i]], std::sqrt(2 * settings.cutoff)}, out);
      out += bytes;
    }
  }
  return buffer;
}

// Along camera z the depth image moves as if the eye stood z_t further back; the program's own offset is then
// 0.
std::vector<Vec4> constants_of(const kernels::SplatProgram& program, kernels::View view,
                               const Splatting& settings, double depth_offset) {
  const bool visibility =
      std::ranges::count(kernels::visibility_programs(), program.file, &kernels::SplatProgram::file) > 0;
  if (visibility && settings.depth_offset_scheme == DepthOffsetScheme::camera_z) {
    view.object_to_camera[3].z += std::exchange(depth_offset, 0);
  }
  return program.constants(view, settings.cutoff, depth_offset);
}

// In the order in which they are to share the card's memory.
void place_buffers(const Splatting& settings, std::vector<Buffer>& buffers) {
  constexpr double kMegabyte = 1 << 20;
  double left = settings.video_megabytes * kMegabyte;
  for (Buffer& buffer : buffers) {
    const auto bytes = static_cast<double>(buffer.bytes.size());
    const bool video = settings.vertex_memory == VertexMemory::automatic
                           ? bytes <= left
                           : settings.vertex_memory == VertexMemory::video;
    buffer.place = video ? MemoryPlace::video : MemoryPlace::agp;
    if (video) left -= bytes;
  }
}

// One of the two passes: its program, its state, and which buffer it draws instead of a SurfelBuffer.
struct RecordedPass {
  const kernels::SplatProgram& program;
  Draw draw;
  std::vector<std::uint32_t> vertex_buffers;

  void append(const DrawnRange& range, const kernels::View& view, const Splatting& settings, Trace& trace) {
    draw.vertex_buffer = vertex_buffers[range.buffer];
    draw.constants = constants_of(program, view, settings, range.depth_offset);
    draw.base_vertex = range.first * kQuadVertices;
    draw.index_count = range.count * kQuadIndices;
    trace.commands.emplace_back(draw);
  }
};

RecordedPass make_pass(const kernels::SplatProgram& program, std::uint32_t vertex_program,
                       const Splatting& settings) {
  RecordedPass pass{program, {}, {}};
  pass.draw.vertex_program = vertex_program;
  pass.draw.vertex_stride = kernels::vertex_bytes(program.fields);
  pass.draw.attributes = kernels::attributes_of(program.fields);
  if (settings.faces == Faces::front) pass.draw.state.cull = CullMode::counter_clockwise;
  return pass;
}

// Fills the trace's buffers. Passes with the same vertices share them.
void add_buffers(std::span<const SurfelBuffer> buffers, const kernels::View& view, const Splatting& settings,
                 RecordedPass& visibility, RecordedPass& splats, Trace& trace) {
  std::size_t most = 0;
  for (const SurfelBuffer& buffer : buffers) most = std::max(most, buffer.surfels.size());
  trace.buffers.push_back(quad_indices(std::min(most, kSurfelsADraw)));
  const bool shared = std::ranges::equal(splats.program.fields, visibility.program.fields);
  const auto add = [&](RecordedPass& pass, const SurfelBuffer& buffer) {
    pass.vertex_buffers.push_back(static_cast<std::uint32_t>(trace.buffers.size()));
    trace.buffers.push_back(vertex_buffer(pass.program, buffer, view, settings));
  };
  for (const SurfelBuffer& buffer : buffers) {
    add(visibility, buffer);
    if (!shared) add(splats, buffer);
  }
  if (shared) splats.vertex_buffers = visibility.vertex_buffers;
}

// The splats of the frame that refines one of `ranges`, of which only the buffers are needed.
RecordedPass add_still_pass(const RecordedPass& splats, std::span<const SurfelBuffer> buffers,
                            std::span<const DrawnRange> ranges, const kernels::View& view,
                            const Splatting& settings, Trace& trace) {
  RecordedPass still = splats;
  still.draw.pixel_program = static_cast<std::uint32_t>(trace.programs.size());
  still.draw.state.source_factor = BlendFactor::one;
  trace.programs.push_back(kernels::shader_text(kernels::kWeightedSplatPixelProgram));
  for (std::uint32_t i = 0; i < buffers.size(); ++i) {
    if (std::ranges::find(ranges, i, &DrawnRange::buffer) == ranges.end()) continue;
    const std::span<const Surfel> surfels = buffers[i].surfels;
    const std::vector<VertexWeights> weights(surfels.size(), equal_weights(buffers[i].still_weight));
    still.vertex_buffers[i] = static_cast<std::uint32_t>(trace.buffers.size());
    trace.buffers.push_back(vertex_buffer(still.program, {surfels, weights}, view, settings));
  }
  return still;
}

Trace trace_of(std::span<const SurfelBuffer> buffers, std::span<const std::vector<DrawnRange>> frames,
               const kernels::View& view, const Splatting& settings, const SplatPass& pass) {
  Trace trace;
  trace.width = static_cast<std::uint32_t>(view.width);
  trace.height = static_cast<std::uint32_t>(view.height);
  if (std::ranges::all_of(buffers, [](const SurfelBuffer& buffer) { return buffer.surfels.empty(); })) {
    trace.commands.emplace_back(Clear{});
    return trace;
  }

  RecordedPass visibility = make_pass(kernels::visibility_program(settings.visibility_program), 0, settings);
  visibility.draw.state.color_write = false;

  RecordedPass splats = make_pass(splat_program(settings, pass), 1, settings);
  splats.draw.pixel_program = 2;
  splats.draw.texture = 0;
  DrawState& state = splats.draw.state;
  state.depth_write = false;
  state.blend = true;
  state.source_factor = pass.sum_weights ? BlendFactor::one : BlendFactor::src_alpha;
  state.destination_factor = BlendFactor::one;

  add_buffers(buffers, view, settings, visibility, splats, trace);
  const auto shape = settings.circular_cutoff ? kernels::CutoffShape::circle : kernels::CutoffShape::square;
  trace.textures.push_back(kernels::alpha_texture(settings.cutoff, texture_length(settings), shape));
  trace.programs = {kernels::shader_text(visibility.program.file), kernels::shader_text(splats.program.file),
                    kernels::shader_text(pass.sum_weights ? kernels::kWeightedSplatPixelProgram
                                                          : kernels::kSplatPixelProgram)};

  const auto add_frame = [&](const std::vector<DrawnRange>& ranges, RecordedPass& second, bool normalize) {
    if (!trace.commands.empty()) trace.commands.emplace_back(Present{});
    trace.commands.emplace_back(Clear{});
    for (RecordedPass* recorded : {&visibility, &second})
      for (const DrawnRange& range : ranges) recorded->append(range, view, settings, trace);
    if (normalize) trace.commands.emplace_back(NormalizeOnHost{});
  };
  for (const std::vector<DrawnRange>& ranges : frames) add_frame(ranges, splats, pass.normalize_on_host);
  if (pass.refine) {
    RecordedPass still = add_still_pass(splats, buffers, frames.back(), view, settings, trace);
    add_frame(frames.back(), still, true);
  }
  place_buffers(settings, trace.buffers);
  return trace;
}

}  // namespace

Buffer quad_indices(std::size_t quads) {
  constexpr std::uint16_t order[kQuadIndices] = {0, 1, 2, 0, 2, 3};
  Buffer buffer;
  buffer.bytes.resize(quads * kQuadIndices * sizeof(std::uint16_t));
  for (std::size_t i = 0; i < quads * kQuadIndices; ++i) {
    const auto index = static_cast<std::uint16_t>(i / kQuadIndices * kQuadVertices + order[i % kQuadIndices]);
    std::memcpy(buffer.bytes.data() + i * sizeof index, &index, sizeof index);
  }
  return buffer;
}

kernels::View view_of(const Camera& camera, const FrameSize& frame) {
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
  for (std::size_t i = 0; i < kQuadVertices; ++i) {
    const glm::dvec2 y = reach * (2.0 * kernels::kQuadCorners[i] - 1.0);
    corners[i] = glm::dvec3(surfel.position) + y.x * axes.s + y.y * axes.t;
  }
  return corners;
}

int texture_length(const Splatting& settings) {
  return settings.texture_length > 0 ? settings.texture_length : kernels::optimal_length(settings.cutoff);
}

Trace splat_trace(std::span<const SurfelBuffer> buffers, std::span<const std::vector<DrawnRange>> frames,
                  const kernels::View& view, const Splatting& settings, const SplatPass& pass) {
  const double unit = unit_of(splat_program(settings, pass), view);
  if (unit == 1) return trace_of(buffers, frames, view, settings, pass);
  std::vector<std::vector<Surfel>> surfels;
  std::vector<SurfelBuffer> buffers_in_unit(buffers.begin(), buffers.end());
  for (SurfelBuffer& buffer : buffers_in_unit) {
    for (Surfel& surfel : surfels.emplace_back(buffer.surfels.begin(), buffer.surfels.end())) {
      surfel.position *= static_cast<float>(unit);
      surfel.radius *= static_cast<float>(unit);
    }
    buffer.surfels = surfels.back();
  }
  std::vector<std::vector<DrawnRange>> frames_in_unit(frames.begin(), frames.end());
  for (std::vector<DrawnRange>& ranges : frames_in_unit)
    for (DrawnRange& range : ranges) range.depth_offset *= unit;
  return trace_of(buffers_in_unit, frames_in_unit, in_unit(view, unit), settings, pass);
}

Trace splat_trace(const SurfelBuffer& surfels, const kernels::View& view, const Splatting& settings,
                  const SplatPass& pass) {
  std::vector<DrawnRange> ranges;
  for (std::size_t first = 0; first < surfels.surfels.size(); first += kSurfelsADraw) {
    const std::size_t count = std::min(kSurfelsADraw, surfels.surfels.size() - first);
    ranges.push_back(
        {0, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), settings.depth_offset});
  }
  return splat_trace({&surfels, 1}, {&ranges, 1}, view, settings, pass);
}

std::vector<Command> seen_from(const kernels::View& view, const Splatting& settings, const Trace& trace) {
  std::vector<Command> commands = trace.commands;
  for (Command& command : commands) {
    if (auto* draw = std::get_if<Draw>(&command)) {
      const kernels::SplatProgram& program =
          kernels::splat_program(trace.programs[draw->vertex_program].name);
      draw->constants = constants_of(program, view, settings, settings.depth_offset);
    }
  }
  return commands;
}

}  // namespace splatscope::traces
