#include "studies/wished_hardware.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "kernels/splat_programs.h"
#include "sim/fidelity/throughput.h"
#include "studies/reference_comparison.h"
#include "traces/weight_capture.h"

namespace splatscope::studies {
namespace {

using traces::Algorithm;
constexpr Algorithm kAlgorithms[] = {Algorithm::no_ewa, Algorithm::ewa_per_pixel, Algorithm::ewa_per_surfel};

std::string counted(int number, std::string_view what) {
  return fmt::format("{} {}{}", number, what, number > 1 ? "s" : "");
}

std::vector<Hardware> make_list() {
  std::vector<Hardware> list{{.name = "as it was", .cost = "-"}};
  for (const int units : {1, 3, 4, 6, 8}) {
    list.push_back({.name = counted(units, "vertex unit"),
                    .cost = fmt::format("{:+} vertex units", units - 2),
                    .vertex_units = units});
  }
  list.push_back({.name = "unorm16 frame", .cost = "8 bytes a pixel for 4", .frame = FrameFormat::unorm16});
  list.push_back({.name = "half frame", .cost = "8 bytes a pixel for 4", .frame = FrameFormat::half});
  list.push_back({.name = "float frame", .cost = "16 bytes a pixel for 4", .frame = FrameFormat::float32});
  list.push_back({.name = "divider", .cost = "4 dividers; the frame once more", .divider = true});
  list.push_back(
      {.name = "4 corners a vertex", .cost = "a loop over the corners", .geometry = Geometry::four_corners});
  list.push_back(
      {.name = "point sprites", .cost = "oPts; circles, no EWA", .geometry = Geometry::point_sprites});
  list.push_back({.name = "short programs", .cost = "nothing", .short_programs = true});
  for (const int units : {1, 3, 4, 6, 8}) {
    list.push_back({.name = fmt::format("short, {}", counted(units, "unit")),
                    .cost = fmt::format("{:+} vertex units", units - 2),
                    .short_programs = true,
                    .vertex_units = units});
  }
  list.push_back({.name = "short, divider, half",
                  .cost = "dividers, 8 bytes a pixel",
                  .short_programs = true,
                  .frame = FrameFormat::half,
                  .divider = true});
  list.push_back({.name = "the same, 4 units",
                  .cost = "+2 vertex units more",
                  .short_programs = true,
                  .vertex_units = 4,
                  .frame = FrameFormat::half,
                  .divider = true});
  return list;
}

Machine machine_with(std::string_view name, const Hardware& hardware) {
  Machine machine = machine::load(name);
  machine::set(machine, fmt::format("vertex.units={}", hardware.vertex_units));
  return with_frame(std::move(machine), hardware.frame);
}

traces::Scene scene_with(traces::Scene scene, const Hardware& hardware, Algorithm algorithm) {
  scene.splatting.algorithm = algorithm;
  if (hardware.short_programs) {
    scene.splatting.visibility_program = "corner";
    scene.splatting.ewa_program = "facing";
  }
  if (hardware.geometry ==
      Geometry::point_sprites) {  // across the camera's axis quads are the sprites' squares
    const glm::vec3 normal(glm::normalize(scene.camera.eye - scene.camera.target));
    for (traces::Surfel& surfel : scene.surfels) surfel.normal = normal;
  }
  return scene;
}

// The inputs of a program that tell the four corners of a quad apart.
std::uint32_t corner_inputs(const kernels::SplatProgram& program) {
  const kernels::Surfel surfel{{1, 2, 3}, {0.5, 0, 0}, {0, 0.5, 0}, 1, 1, {1, 1, 1}};
  std::uint32_t inputs = 0;
  for (const kernels::VertexField& field : program.fields) {
    if (field.value({surfel, {0, 0}, 1}) != field.value({surfel, {1, 1}, 1})) inputs |= 1u << field.input;
  }
  return inputs;
}

// A recorded trace as point sprites would have it: shorter programs and vertices. Its work stays that of the
// quads.
void make_sprites(Trace& trace) {
  constexpr std::uint32_t kVisibilityBytes = 16, kSplatBytes = 24;
  trace.programs[0] = kernels::shader_text("visibility_sprite.vs");
  trace.programs[1] = kernels::shader_text("splat_sprite.vs");
  for (Command& command : trace.commands) {
    if (auto* draw = std::get_if<Draw>(&command)) {
      draw->vertex_stride = draw->vertex_program == 0 ? kVisibilityBytes : kSplatBytes;
    }
  }
}

sim::WhatIf what_if_of(const Hardware& hardware, const Trace& trace) {
  sim::WhatIf what_if;
  what_if.point_sprites = hardware.geometry == Geometry::point_sprites;
  what_if.divided_pixels_per_clock = hardware.divider ? 4 : 0;
  if (hardware.geometry == Geometry::four_corners) {
    what_if.corner_inputs.resize(trace.programs.size());
    for (const Command& command : trace.commands) {
      const auto* draw = std::get_if<Draw>(&command);
      if (!draw) continue;
      what_if.corner_inputs[draw->vertex_program] =
          corner_inputs(kernels::splat_program(trace.programs[draw->vertex_program].name));
    }
  }
  return what_if;
}

// Pictures and work, drawn once for all hardware that draws the same.
class Drawings {
 public:
  Drawings(const traces::Scene& scene, std::string_view machine)
      : scene_(scene), machine_(machine), reference_(single_surface_reference(scene)) {}

  struct Drawing {
    Trace trace;
    std::vector<DrawWork> work;
    double psnr = 0;
  };
  const Drawing& of(const Hardware& hardware, Algorithm algorithm) {
    const Key key{hardware.short_programs, hardware.frame, hardware.geometry == Geometry::point_sprites,
                  algorithm};
    if (const auto found = drawings_.find(key); found != drawings_.end()) return found->second;
    const traces::Scene scene = scene_with(scene_, hardware, algorithm);
    const Machine machine = machine_with(machine_, hardware);
    Drawing drawing;
    drawing.trace = algorithm == Algorithm::ewa_per_pixel
                        ? traces::record(scene, machine.numbers).trace
                        : traces::record(scene, weights_of(scene, hardware, machine.numbers)).trace;
    Rendered rendered = render(drawing.trace, render_options(machine));
    drawing.work = std::move(rendered.work);
    drawing.psnr = psnr(rendered.frame, reference_);
    if (hardware.geometry == Geometry::point_sprites) make_sprites(drawing.trace);
    return drawings_.emplace(key, std::move(drawing)).first->second;
  }

 private:
  using Key = std::tuple<bool, FrameFormat, bool, Algorithm>;

  // Of `scene`, which differs in what is captured by the key alone.
  const traces::CapturedWeights& weights_of(const traces::Scene& scene, const Hardware& hardware,
                                            const NumberFormats& numbers) {
    const std::pair key(hardware.frame, hardware.geometry == Geometry::point_sprites);
    const auto found = weights_.find(key);
    if (found != weights_.end()) return found->second;
    return weights_.emplace(key, traces::capture_weights(scene, numbers)).first->second;
  }

  const traces::Scene& scene_;
  std::string machine_;
  kernels::SplatSums reference_;
  std::map<Key, Drawing> drawings_;
  std::map<std::pair<FrameFormat, bool>, traces::CapturedWeights> weights_;
};

HardwareRow::Cell cell_of(const Drawings::Drawing& drawing, const Hardware& hardware,
                          const Machine& machine) {
  const sim::Result timing =
      sim::estimate_throughput(drawing.trace, drawing.work, machine, what_if_of(hardware, drawing.trace));
  const auto memory = std::ranges::find(timing.units, "memory0", &sim::UnitBooks::name);
  const double bytes =
      static_cast<double>(memory->busy) * machine.memory.channels * machine.memory.channel_bytes_per_clock;
  return {rate_of(timing), bytes / 1e6, drawing.psnr};
}

}  // namespace

std::span<const Hardware> wished_hardware() {
  static const std::vector<Hardware> list = make_list();
  return list;
}

std::vector<HardwareRow> hardware_rows(const traces::Scene& scene, std::string_view machine,
                                       std::span<const Hardware> hardware, const Progress& progress) {
  Drawings drawings(scene, machine);
  std::vector<HardwareRow> rows;
  for (const Hardware& one : hardware) {
    HardwareRow row{one, std::string(machine), {}};
    for (const Algorithm algorithm : kAlgorithms) {
      row.cells.push_back(cell_of(drawings.of(one, algorithm), one, machine_with(machine, one)));
    }
    rows.push_back(std::move(row));
    tell(progress, rows.size(), hardware.size());
  }
  return rows;
}

HardwarePicture hardware_picture(const traces::Scene& scene, std::string_view machine,
                                 const Hardware& hardware, Algorithm algorithm) {
  const traces::Scene changed = scene_with(scene, hardware, algorithm);
  const Machine with = machine_with(machine, hardware);
  const Frame frame = draw_frame(changed, with);
  return {picture_of(frame), psnr(frame, single_surface_reference(scene))};
}

std::string header_of_hardware() {
  return fmt::format("{:<20} {:<16} {:<20} {:<20} {:<20} {:>8} {:>6} {:>6}", "hardware", "machine", "no-ewa",
                     "ewa-per-pixel", "ewa-per-surfel", "MB/frame", "PSNR-p", "PSNR-s");
}

std::string line_of(const HardwareRow& row) {
  const auto rate = [&](std::size_t i) {
    return fmt::format("{:>6.1f} {}", row.cells[i].rate.fps, row.cells[i].rate.bottleneck);
  };
  return fmt::format("{:<20} {:<16} {:<20} {:<20} {:<20} {:>8.1f} {:>6.1f} {:>6.1f}", row.hardware.name,
                     row.machine, rate(0), rate(1), rate(2), row.cells[2].megabytes, row.cells[1].psnr,
                     row.cells[2].psnr);
}

}  // namespace splatscope::studies
