#include "traces/volume_trace.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "kernels/object_space_ewa/alpha_texture.h"
#include "kernels/object_space_ewa/programs.h"
#include "kernels/reference/volume/footprint.h"
#include "kernels/voxel_ewa/programs.h"
#include "model/error.h"
#include "model/stop.h"
#include "model/vertex/vertex_fetch.h"
#include "traces/splat_trace.h"
#include "traces/trace_file.h"
#include "traces/volume_sheets.h"

namespace splatscope::traces {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

constexpr std::int16_t kCornerSigns[kQuadVertices][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

class VertexWriter {
 public:
  explicit VertexWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  template <class T>
  void put(T value) {
    const auto* raw = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), raw, raw + sizeof value);
  }
  void put(const dvec3& v) {
    for (int i = 0; i < 3; ++i) put(static_cast<float>(v[i]));
  }

 private:
  std::vector<std::byte>& bytes_;
};

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

// Of 255, what the pixel programs scale contributions by: each 1/sqrt 2 of the one before it.
constexpr std::array<int, 12> kPixelSteps{255, 181, 128, 91, 64, 45, 32, 23, 16, 11, 8, 6};

// Whether all voxels have one variance, and places that a short4 holds.
bool on_grid(const kernels::VolumeSplats& splats) {
  if (splats.kernels.size() != 1) return false;
  return std::ranges::all_of(splats.splats, [&](const kernels::VolumeSplat& splat) {
    const dvec3 place = (dvec3(splat.position) - splats.low) / splats.sheet_spacing;
    return std::max({place.x, place.y, place.z}) < 32767;
  });
}

class Recorder {
 public:
  Recorder(const kernels::View& view, const kernels::VolumeSplats& splats,
           const VolumeTraceSettings& settings)
      : view_(view),
        splats_(splats),
        settings_(settings),
        voxels_(splats.splats.size()),
        planner_{view, settings.cutoff, settings.gains, settings.shared_variance && on_grid(splats)} {}

  VolumeTrace record() {
    look_at_voxels();
    Trace& trace = result_.trace;
    trace.width = static_cast<std::uint32_t>(view_.width);
    trace.height = static_cast<std::uint32_t>(view_.height);
    trace.surfaces = 1;
    const glm::vec3 behind(settings_.background);
    trace.commands.emplace_back(Clear{.color = {behind.r, behind.g, behind.b, 0}});
    if (result_.splats == 0) return std::move(result_);
    trace.buffers.resize(kBuffers);
    trace.programs = {
        kernels::shader_text(kernels::kVoxelGridProgram), kernels::shader_text(kernels::kVoxelProgram),
        kernels::shader_text(kernels::kSheetProgram), kernels::shader_text(kernels::kSheetPixelProgram)};
    for (const int steps : kPixelSteps) trace.programs.push_back(kernels::voxel_pixel_program(steps));
    const double cutoff = settings_.cutoff / 2;  // c of Ren 2002, Eq. 14
    trace.textures = {kernels::alpha_texture(cutoff,
                                             settings_.texture_length > 0
                                                 ? settings_.texture_length
                                                 : std::min(kernels::optimal_length(cutoff), kMaxTextureEdge),
                                             kernels::CutoffShape::circle, settings_.texture_bits)};
    for (const SheetPlan& plan : plans()) {
      if (!plan.rectangle.empty()) add_sheet(plan);
    }
    finish_buffers();
    return std::move(result_);
  }

 private:
  enum BufferNumber : std::uint32_t { kSharedVertices, kOwnVertices, kSheetVertices, kIndexBuffer, kBuffers };
  enum ProgramNumber : std::uint32_t { kSheetVertex = kVoxelKinds, kSheetPixels, kVoxelPixels };

  dmat3 object_variance(const kernels::VolumeSplat& splat) const {
    const dmat3& variance = splats_.kernels[splat.kernel];
    if (!(splat.flatness > 0)) return variance;
    return kernels::flattened(variance, glm::normalize(dvec3(splat.normal)), flattening(splat));
  }

  // s of Zwicker 2002, Eq. 37.
  static double flattening(const kernels::VolumeSplat& splat) {
    return 1 / (1 - static_cast<double>(splat.flatness));
  }

  HostVoxel look_at(const kernels::VolumeSplat& splat) const {
    HostVoxel voxel;
    const dvec3 camera = view_.camera_space(splat.position);
    const auto print =
        kernels::footprint(view_, kernels::Projection::perspective, kernels::VolumePrefilter::ewa, camera,
                           kernels::camera_variance(view_, object_variance(splat)));
    if (!print) return voxel;
    const dvec2 reach = print->reach(settings_.cutoff);
    voxel.low = print->center - reach;
    voxel.high = print->center + reach;
    voxel.conic = dvec3(print->conic[0][0], 2 * print->conic[0][1], print->conic[1][1]);
    const bool in_frame = voxel.high.x > 0 && voxel.high.y > 0 &&
                          voxel.low.x < static_cast<float>(view_.width) &&
                          voxel.low.y < static_cast<float>(view_.height);
    const dvec3 turned = view_.camera_direction(splat.normal);
    const dvec3 normal = turned == dvec3(0) ? turned : glm::normalize(turned);
    voxel.flat = splat.flatness > 0;
    voxel.color =
        kernels::shaded(settings_.light, kernels::Projection::perspective, camera, normal, splat.color);
    double weight = static_cast<double>(splat.weight);
    if (voxel.flat)
      weight *= kernels::flattened_weight(glm::dot(normal, glm::normalize(camera)), flattening(splat));
    voxel.weight = static_cast<float>(weight);
    voxel.drawn = in_frame && voxel.weight > 0;  // not where it was too small for a float
    voxel.opacity =
        static_cast<float>(weight * print->peak * kernels::opacity_scale(view_, settings_.cutoff));
    return voxel;
  }

  void look_at_voxels() {
    oneapi::tbb::parallel_for(std::size_t{0}, voxels_.size(), [&](std::size_t i) {
      stop_if_asked();
      voxels_[i] = look_at(splats_.splats[i]);
    });
    for (const HostVoxel& voxel : voxels_) {
      if (!voxel.drawn) continue;
      ++result_.splats;
      planner_.heaviest = std::max(planner_.heaviest, static_cast<double>(voxel.weight));
    }
    result_.left_out = voxels_.size() - result_.splats;
  }

  // Of all sheets, from back to front.
  std::vector<SheetPlan> plans() const {
    const kernels::SheetAxis axis = kernels::sheet_axis(view_, splats_, std::nullopt);
    const kernels::SheetOrder order = kernels::sheet_order(splats_, axis.axis);
    std::vector<SheetPlan> plans(order.first.size() - 1);
    oneapi::tbb::parallel_for(std::size_t{0}, plans.size(), [&](std::size_t i) {
      const std::size_t sheet = axis.last_is_nearest ? i : plans.size() - 1 - i;
      plans[i] = planner_.plan(
          voxels_,
          std::span(order.splats).subspan(order.first[sheet], order.first[sheet + 1] - order.first[sheet]));
    });
    return plans;
  }

  void add_sheet(const SheetPlan& plan) {
    const std::uint32_t base = add_rectangle(plan.rectangle);
    Draw clear = sheet_draw(base, 0);
    clear.target = 1;
    result_.trace.commands.emplace_back(clear);
    for (std::size_t level = kVoxelLevels; level-- > 0;) {
      if (plan.rescale[level] < 255) {
        Draw rescale = sheet_draw(base, plan.rescale[level]);
        rescale.target = 1;
        rescale.state.blend = true;
        rescale.state.source_factor = BlendFactor::zero;
        rescale.state.destination_factor = BlendFactor::src_color;
        result_.trace.commands.emplace_back(rescale);
      }
      for (const VoxelKind kind : {kSharedVariance, kOwnVariance}) add_voxels(kind, level, plan);
    }
    Draw composite = sheet_draw(base, plan.composite);
    composite.source = 1;
    composite.pixel_program = kSheetPixels;
    composite.state.blend = true;
    composite.state.destination_factor = BlendFactor::inv_src_alpha;
    result_.trace.commands.emplace_back(composite);
    ++result_.sheets;
  }

  // Returns its first vertex. Pixels begin at the window's integers.
  std::uint32_t add_rectangle(const Rectangle& r) {
    std::vector<std::byte>& bytes = result_.trace.buffers[kSheetVertices].bytes;
    const auto base = static_cast<std::uint32_t>(bytes.size() / kSheetStride);
    VertexWriter writer(bytes);
    const dvec2 corners[kQuadVertices] = {
        {r.left, r.top}, {r.right, r.top}, {r.right, r.bottom}, {r.left, r.bottom}};
    for (const dvec2& corner : corners) {
      const dvec2 from_center = corner - view_.center();
      writer.put(dvec3(2 * from_center.x / view_.width, -2 * from_center.y / view_.height, 0));
      writer.put(static_cast<float>(corner.x / view_.width));
      writer.put(static_cast<float>(corner.y / view_.height));
    }
    return base;
  }

  static constexpr std::uint32_t kSheetStride = 20;

  static Draw undepthed() {
    Draw draw;
    draw.index_buffer = kIndexBuffer;
    draw.state.depth_test = draw.state.depth_write = false;
    return draw;
  }

  // A rectangle of the diffuse colour `steps`/255 in every channel.
  Draw sheet_draw(std::uint32_t base, int steps) const {
    Draw draw = undepthed();
    draw.vertex_program = kSheetVertex;
    draw.vertex_buffer = kSheetVertices;
    draw.vertex_stride = kSheetStride;
    draw.attributes = {{0, VertexFormat::float3, 0}, {1, VertexFormat::float2, 12}};
    draw.base_vertex = base;
    draw.index_count = kQuadIndices;
    const float shade = static_cast<float>(steps) / 255;
    draw.constants = {{shade, shade, shade, shade}};
    return draw;
  }

  Draw voxel_draw(VoxelKind kind, std::size_t level, const SheetPlan& plan) const {
    // The largest contribution of the draw; more than 1 saturates.
    const double most = std::min(1.0, plan.gain[level] * plan.opacity[level]);
    std::size_t program = 0;
    while (program + 1 < kPixelSteps.size() && kPixelSteps[program + 1] >= 255 * most) ++program;
    Draw draw = undepthed();
    draw.vertex_program = static_cast<std::uint32_t>(kind);
    draw.vertex_buffer = kind == kSharedVariance ? kSharedVertices : kOwnVertices;
    draw.pixel_program = static_cast<std::uint32_t>(kVoxelPixels + program);
    draw.texture = 0;
    draw.target = 1;
    draw.state.blend = true;
    draw.state.destination_factor = BlendFactor::one;
    std::uint32_t offset = 0;
    const auto add = [&](int input, VertexFormat format) {
      draw.attributes.push_back(
          {static_cast<std::uint8_t>(input), format, static_cast<std::uint16_t>(offset)});
      offset += vertex::size_of(format);
    };
    if (kind == kSharedVariance) {
      add(kernels::kVoxelPositionInput, VertexFormat::short4);
    } else {
      add(kernels::kVoxelPositionInput, VertexFormat::float3);
    }
    add(kernels::kVoxelCornerInput, VertexFormat::short2);
    if (settings_.float_colors) {
      add(kernels::kVoxelColorInput, VertexFormat::float4);
    } else {
      add(kernels::kVoxelColorInput, VertexFormat::d3dcolor);
    }
    if (kind == kOwnVariance) {
      for (int row = 0; row < 3; ++row) add(kernels::kVoxelVarianceInput + row, VertexFormat::float3);
    }
    draw.vertex_stride = offset;
    // On a grid positions are numbers of voxels; elsewhere the general program takes object units.
    const dvec3 scale = kind == kSharedVariance ? splats_.sheet_spacing : dvec3(1),
                origin = kind == kSharedVariance ? splats_.low : dvec3(0);
    glm::dmat4 to_object(1.0);
    for (int i = 0; i < 3; ++i) {
      to_object[i][i] = scale[i];
      to_object[3][i] = origin[i];
    }
    const double unit = planner_.weight_of(level) * kernels::opacity_scale(view_, settings_.cutoff) *
                        plan.gain[level] * 255 / kPixelSteps[program];
    draw.constants = kernels::voxel_constants(
        view_, to_object, kind == kSharedVariance ? &splats_.kernels[0] : nullptr, settings_.cutoff, unit);
    return draw;
  }

  void add_voxels(VoxelKind kind, std::size_t level, const SheetPlan& plan) {
    const std::vector<std::uint32_t>& numbers = plan.voxels[level][kind];
    if (numbers.empty()) return;
    Draw draw = voxel_draw(kind, level, plan);
    std::vector<std::byte>& bytes = result_.trace.buffers[draw.vertex_buffer].bytes;
    for (std::size_t first = 0; first < numbers.size(); first += kSurfelsADraw) {
      const std::size_t count = std::min(kSurfelsADraw, numbers.size() - first);
      draw.base_vertex = static_cast<std::uint32_t>(bytes.size() / draw.vertex_stride);
      draw.index_count = static_cast<std::uint32_t>(count) * kQuadIndices;
      for (const std::uint32_t k : std::span(numbers).subspan(first, count)) {
        stop_if_asked();
        add_vertices(kind, planner_.weight_of(level), k, bytes);
      }
      most_quads_ = std::max(most_quads_, count);
      result_.trace.commands.emplace_back(draw);
    }
    for (const std::uint32_t k : numbers) result_.flat += voxels_[k].flat;
  }

  // `weight`: what the vertices' opacity is relative to.
  void add_vertices(VoxelKind kind, double weight, std::uint32_t k, std::vector<std::byte>& bytes) {
    const kernels::VolumeSplat& splat = splats_.splats[k];
    const HostVoxel& voxel = voxels_[k];
    const double alpha = static_cast<double>(voxel.weight) / weight;
    const dvec3 on_grid = (dvec3(splat.position) - splats_.low) / splats_.sheet_spacing;
    const dmat3 variance = kind == kOwnVariance ? object_variance(splat) : dmat3(1.0);
    VertexWriter writer(bytes);
    for (const auto& corner : kCornerSigns) {
      if (kind == kSharedVariance) {
        for (int i = 0; i < 3; ++i) writer.put(static_cast<std::int16_t>(std::lround(on_grid[i])));
        writer.put(std::int16_t{1});
      } else {
        writer.put(dvec3(splat.position));
      }
      writer.put(corner[0]);
      writer.put(corner[1]);
      if (settings_.float_colors) {
        writer.put(voxel.color);
        writer.put(static_cast<float>(alpha));
      } else {
        for (const float channel : {voxel.color.b, voxel.color.g, voxel.color.r})
          writer.put(byte_of(static_cast<double>(channel)));
        writer.put(byte_of(alpha));
      }
      if (kind == kOwnVariance) {
        for (int row = 0; row < 3; ++row) writer.put(variance[row]);
      }
    }
  }

  void finish_buffers() {
    result_.trace.buffers[kIndexBuffer] = quad_indices(std::max<std::size_t>(most_quads_, 1));
    for (const std::uint32_t buffer : {kSharedVertices, kOwnVertices, kSheetVertices})
      result_.vertex_bytes += result_.trace.buffers[buffer].bytes.size();
    // What the application writes anew each frame, as its voxels are shaded, lies in AGP memory.
    for (const std::uint32_t buffer : {kSharedVertices, kOwnVertices})
      result_.trace.buffers[buffer].place = MemoryPlace::agp;
  }

  const kernels::View& view_;
  const kernels::VolumeSplats& splats_;
  const VolumeTraceSettings& settings_;
  std::vector<HostVoxel> voxels_;
  SheetPlanner planner_;
  std::size_t most_quads_ = 0;
  VolumeTrace result_;
};

bool has_finite_constants(const Trace& trace) {
  return std::ranges::all_of(trace.commands, [](const Command& command) {
    const auto* draw = std::get_if<Draw>(&command);
    return !draw || std::ranges::all_of(draw->constants, [](const Vec4& constant) {
      return std::ranges::all_of(constant, [](float c) { return std::isfinite(c); });
    });
  });
}

}  // namespace

VolumeTrace volume_trace(const kernels::View& view, const kernels::VolumeSplats& splats,
                         const VolumeTraceSettings& settings) {
  return Recorder(view, splats, settings).record();
}

VolumeTrace record(const VolumeScene& scene) {
  if (scene.settings.prefilter != kernels::VolumePrefilter::ewa) {
    throw UserError(
        scene.file, scene.prefilter_line,
        "volume.prefilter is not \"ewa\", expected it, the only filter of the machine's programs");
  }
  VolumeTrace recorded = volume_trace(
      scene.view, scene.splats(),
      {.cutoff = scene.settings.cutoff, .light = scene.settings.light, .background = scene.background});
  if (!has_finite_constants(recorded.trace)) {
    throw UserError(scene.file, 0,
                    "the machine's programs square voxels of this size beyond 32 bits, expected another unit "
                    "of length");
  }
  return recorded;
}

std::string describe(const VolumeCounts& counts) {
  return fmt::format("{} splats ({} flat) in {} sheets, {} left out, {:.1f} MB of vertices", counts.splats,
                     counts.flat, counts.sheets, counts.left_out,
                     static_cast<double>(counts.vertex_bytes) / 1e6);
}

}  // namespace splatscope::traces
