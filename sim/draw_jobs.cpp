#include "sim/draw_jobs.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include "model/command/load_program.h"
#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/number/frame_value.h"
#include "model/pixel/pixel_program.h"

namespace splatscope::sim {
namespace {

std::uint32_t bytes_of(DepthFormat format) {
  return format == DepthFormat::z16 ? 2 : 4;
}

// Of whole blocks.
std::uint64_t texture_bytes(const Texture& texture) {
  const auto blocks = [](std::uint32_t texels) { return (texels + kTexelBlockEdge - 1) / kTexelBlockEdge; };
  return std::uint64_t{blocks(texture.width)} * blocks(texture.height) * kTexelBlockBytes;
}

// Gives out addresses, each at the start of a row of all banks and channels.
class Allocator {
 public:
  explicit Allocator(const Machine::Memory& memory)
      : alignment_(static_cast<std::uint64_t>(memory.row_bytes) * static_cast<std::uint64_t>(memory.banks) *
                   static_cast<std::uint64_t>(memory.channels)) {}
  std::uint32_t take(std::uint64_t bytes) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
    const std::uint64_t address = next_;
    bytes_ += bytes;
    next_ += (bytes + alignment_ - 1) / alignment_ * alignment_;
    if (bytes_ > kMost)
      throw UserError("trace", 0,
                      "more than 4 GiB of buffers and textures, expected what a machine of 2002 can hold");
    if (next_ > kMost)
      throw UserError(
          "trace", 0,
          fmt::format("its surfaces, textures and buffers do not fit into 4 GiB, as each begins a "
                      "row of all banks and channels, {} bytes, expected a smaller "
                      "memory.row_bytes, memory.banks or memory.channels",
                      alignment_));
    return static_cast<std::uint32_t>(address);
  }

 private:
  std::uint64_t alignment_;
  std::uint64_t next_ = 0;
  std::uint64_t bytes_ = 0;  // taken, without what lies between
};

// What a job needs to know of a pixel program.
struct PixelWork {
  std::uint64_t clocks = 0;  // of a quad
  bool samples = false;      // a texture
};
PixelWork work_of(const isa::Program& program, const Machine::Pixel& spec) {
  return {clocks_per_quad(program, spec), pixel::PixelProgram(program).texture_stages() != 0};
}

}  // namespace

bool adds_up(const DrawWork& work) {
  std::uint64_t quads = 0, quads_passed = 0, vertices = 0;
  for (std::size_t i = 0; i < work.triangles.size(); i = work.next_recorded(i)) {
    quads += work.triangles[i].quad_count;
    quads_passed += work.triangles[i].quads_passed;
    vertices += work.triangles[i].new_vertices;
  }
  std::uint64_t passed = 0, blocks = 0;  // that the quads themselves have
  for (const QuadWork& quad : work.quads) {
    blocks += quad.texel_block_count;
    passed += quad.passed != 0;
  }
  if (work.samples_only) vertices = 0;
  return quads == work.quads.size() && quads_passed == passed && vertices == work.shaded_vertices.size() &&
         blocks == work.texel_blocks.size();
}

bool adds_up(const DrawWork& work, const Draw& draw) {
  return work.triangles.size() == draw.index_count / 3 && adds_up(work);
}

std::uint64_t clipped_triangles(const DrawWork& work) {
  return static_cast<std::uint64_t>(std::ranges::count_if(
      work.triangles, [](const TriangleWork& triangle) { return triangle.pieces > 1; }));
}

DrawCounts counts_of(const DrawWork& work, const Draw& draw) {
  DrawCounts counts;
  counts.triangles = work.triangles.size();
  counts.shaded_vertices = work.shaded_vertices.size();
  counts.quads = work.quads.size();
  for (const TriangleWork& triangle : work.triangles) {
    counts.triangles_set_up += triangle.pieces != 0;
    counts.colored_quads += draw.state.color_write ? triangle.quads_passed : 0;
  }
  return counts;
}

void show_all(DrawJob& job, const DrawWork& work) {
  job.triangles = Records(std::span(work.triangles));
  job.shaded_vertices = Records(std::span(work.shaded_vertices));
  job.quads = Records(std::span(work.quads));
  job.texel_blocks = Records(std::span(work.texel_blocks));
  job.counts = counts_of(work, *job.draw);
  job.all_triangles = work.triangles.size();
}

std::uint64_t clocks_per_quad(const isa::Program& program, const Machine::Pixel& spec) {
  int halves = 0;
  for (const isa::Instruction& instruction : program.instructions) {
    const isa::OpcodeInfo* info = isa::find_opcode(program.version, instruction.opcode);
    if (!info || info->unit != isa::OpcodeClass::arithmetic) continue;
    const unsigned mask = instruction.destination.mask;
    halves += info->slots * (((mask & 0x7u) != 0) + ((mask & 0x8u) != 0));
  }
  const int clocks = (halves + spec.instructions_per_clock - 1) / spec.instructions_per_clock;
  return static_cast<std::uint64_t>(std::max(clocks, 1));
}

MemoryLayout lay_out(const Trace& trace, const Machine& machine) {
  MemoryLayout layout;
  layout.color = FrameLines::of(trace.width, trace.height, bytes_per_pixel(machine.numbers.frame));
  layout.depth = FrameLines::of(trace.width, trace.height, bytes_of(machine.numbers.depth));
  Allocator video(machine.memory);
  Allocator agp(machine.memory);
  layout.color_address = video.take(std::uint64_t{layout.color.bytes()} * (1 + trace.surfaces));
  layout.depth_address = video.take(layout.depth.bytes());
  for (const Texture& texture : trace.textures) layout.textures.push_back(video.take(texture_bytes(texture)));
  for (const Buffer& buffer : trace.buffers) {
    layout.buffers.push_back((buffer.place == MemoryPlace::agp ? agp : video).take(buffer.bytes.size()));
  }
  return layout;
}

Needs needs_of(const Trace& trace, std::span<const DrawJob> jobs) {
  Needs needs;
  for (const DrawJob& job : jobs) {
    const Draw& draw = *job.draw;
    for (const std::uint32_t buffer : {draw.vertex_buffer, draw.index_buffer}) {
      needs.agp |= trace.buffers[buffer].place == MemoryPlace::agp;
    }
    needs.depth |= uses_depth(draw);
    needs.color |= draw.state.color_write;
    needs.texture |= job.textured;
  }
  return needs;
}

PreparedDraws prepare_draws(const Trace& trace, const Machine& machine, const MemoryLayout& layout) {
  PreparedDraws prepared;
  std::map<std::uint32_t, std::size_t> program_numbers;
  std::map<std::uint32_t, PixelWork> pixel_work;  // by program
  for (std::size_t command = 0; command < trace.commands.size(); ++command) {
    const Draw* draw = std::get_if<Draw>(&trace.commands[command]);
    if (!draw) continue;
    DrawJob job;
    job.draw = draw;
    job.command = static_cast<std::uint32_t>(command);
    const auto [found, is_new] =
        program_numbers.try_emplace(draw->vertex_program, prepared.vertex_programs.size());
    if (is_new) {
      prepared.vertex_programs.push_back(
          issue_slots(load_program(trace.programs[draw->vertex_program]), machine.vertex));
    }
    job.vertex_program = found->second;
    if (draw->pixel_program) {
      const auto [known, is_new] = pixel_work.try_emplace(*draw->pixel_program);
      if (is_new) known->second = work_of(load_program(trace.programs[*draw->pixel_program]), machine.pixel);
      job.pixel_clocks = known->second.clocks;
      job.textured = binds_texture(*draw) && known->second.samples;
    }
    job.vertex_address = layout.buffers[draw->vertex_buffer];
    job.index_address = layout.buffers[draw->index_buffer] + 2 * draw->first_index;
    if (draw->texture) job.texture_address = layout.textures[*draw->texture];
    if (draw->source) job.texture_address = layout.color_address + *draw->source * layout.color.bytes();
    prepared.jobs.push_back(job);
  }
  return prepared;
}

void give_work(DrawJob& job, const DrawWork& work, bool samples_suffice) {
  if (work.samples_only && !samples_suffice)
    throw ModelError("the work record of command " + std::to_string(work.command) + " holds samples only");
  if (work.command != job.command)
    throw ModelError("command " + std::to_string(job.command) + " of the trace has no work record");
  if (!adds_up(work, *job.draw))
    throw ModelError("the work record of command " + std::to_string(work.command) + " does not add up");
  job.triangles_clipped = clipped_triangles(work);
  if (!work.samples_only) show_all(job, work);  // to the units; an estimate does not look at these
}

void expect_work_of_each_draw(const Trace& trace, std::span<const DrawWork> work) {
  const auto is_draw = [](const Command& command) { return std::holds_alternative<Draw>(command); };
  if (static_cast<std::size_t>(std::ranges::count_if(trace.commands, is_draw)) != work.size())
    throw ModelError("there are not as many work records as draws");
}

PreparedDraws prepare_draws(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                            const MemoryLayout& layout) {
  expect_work_of_each_draw(trace, work);
  PreparedDraws prepared = prepare_draws(trace, machine, layout);
  for (std::size_t i = 0; i < work.size(); ++i) give_work(prepared.jobs[i], work[i]);
  return prepared;
}

}  // namespace splatscope::sim
