#pragma once

#include <algorithm>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "model/command/commands.h"
#include "model/machine/machine.h"
#include "model/work/work.h"

// Small random traces, and simple ones, with work that fits them, and machines with random depths and
// timings. No pictures: the timing simulation looks at no value of a buffer or a texture.
namespace splatscope::sim::testing {

struct RandomTrace {
  Trace trace;
  std::vector<DrawWork> work;
};

class RandomMaker {
 public:
  explicit RandomMaker(unsigned seed) : next_([random = std::mt19937(seed)]() mutable { return random(); }) {}
  // From choices made elsewhere; where they end, the least of everything. So that a failing case can be
  // shrunk, by fewer and by lower choices, to a smallest one (MacIver and Donaldson 2020).
  explicit RandomMaker(std::vector<std::uint32_t> choices)
      : next_([choices = std::move(choices), i = std::size_t{0}]() mutable {
          return i < choices.size() ? choices[i++] : 0;
        }) {}

  RandomTrace trace() {
    RandomTrace made;
    made.trace.width = number(1, 64);
    made.trace.height = number(1, 64);
    made.trace.programs = {
        {"move.vs", "vs_1_1\nmov oPos, v0\nmov oD0, v1\n"},
        {"chain.vs",
         "vs_1_1\ndp4 r0.x, v0, c0\nrsq r1.x, r0.x\nmul r2, v1, c1\nrcp r1.y, r1.x\n"
         "mad r3, r2, r1.y, v1\nrcp r4.w, r0.x\nmul r5, v1, c2\nmul oD0, r5, r4.w\nm4x4 oPos, r3, c4\n"},
        {"color.ps", "ps_1_1\ntex t0\nmul r0, t0, v0\n"}};
    made.trace.textures = {{64, 64, {}}};
    if (chance(0.4)) made.trace.surfaces = 1;
    const auto place = [&] { return chance(0.3) ? MemoryPlace::agp : MemoryPlace::video; };
    made.trace.buffers = {{place(), {}}, {place(), {}}};
    if (chance(0.8)) made.trace.commands.emplace_back(Clear{});
    const auto draws = number(0, 3);
    const bool has_color = chance(0.8);
    for (std::uint32_t i = 0; i < draws; ++i) {
      add_draw(made, has_color);
      if (chance(0.2)) made.trace.commands.emplace_back(Present{});
    }
    if (chance(0.3)) made.trace.commands.emplace_back(NormalizeOnHost{});
    return made;
  }

  // Queues hold 1 to 16 items; caches and DRAM are small, so that a small trace fills them. The
  // post-transform FIFO is left as it is: the work tells the timing which vertices are new.
  Machine machine() {
    Machine made;
    const auto depth = [&] { return int(number(1, 16)); };
    const auto power = [&](int least, std::uint32_t steps) { return least << number(0, steps); };
    made.clock.bus_megahertz = number(20, 400);
    made.vertex = {int(number(1, 4)),
                   int(number(1, 4)),
                   int(number(1, 6)),
                   int(number(1, 6)),
                   int(number(1, 4)),
                   chance(0.5),
                   chance(0.5),
                   int(number(0, 4)),
                   18,
                   depth()};
    made.memory.interleave_bytes = power(64, 2);
    made.memory.channels = power(1, 3);
    made.memory.burst_bytes = power(8, 2);
    made.memory.channel_bytes_per_clock = std::min(power(4, 2), made.memory.burst_bytes);
    made.memory.banks = power(1, 3);
    made.memory.row_bytes = power(256, 3);
    made.memory.precharge_clocks = int(number(0, 8));
    made.memory.activate_clocks = int(number(0, 8));
    made.memory.cas_clocks = int(number(1, 8));
    made.memory.row_active_clocks = int(number(0, 16));
    made.memory.write_recovery_clocks = int(number(0, 8));
    made.memory.turnaround_clocks = int(number(0, 4));
    made.memory.request_queue = depth();
    made.memory.schedule_queue = depth();
    made.memory.bypass_limit = int(number(0, 16));
    made.memory.return_latency = int(number(1, 80));
    made.fetch = {power(16, 2), power(4, 2), power(1, 2), depth(), int(number(1, 4)), int(number(1, 3))};
    made.primitive = {int(number(1, 3)), int(number(0, 5)), depth()};
    made.setup = {int(number(1, 4)), int(number(1, 12)), depth()};
    made.raster = {int(number(1, 2)), int(number(1, 8)), depth()};
    made.depth = {power(4, 3), power(1, 2), depth(), int(number(1, 8)), depth(), chance(0.5)};
    made.texture = {power(4, 4),       power(1, 2), power(16, 2),       8,
                    int(number(1, 4)), depth(),     int(number(1, 12)), depth()};
    made.texture.fill_bytes = std::min(power(8, 3), made.texture.line_bytes);
    made.pixel = {int(number(1, 4)), int(number(1, 2)), int(number(1, 8)), depth()};
    made.blend = {power(4, 3), power(1, 2), depth()};
    made.agp = {power(4, 2), double(number(0, 500)), depth()};
    made.host.command_nanoseconds = number(0, 2000);
    made.host.uncached_read_nanoseconds = number(1, 40);
    made.clock.core_megahertz = number(20, 400);  // below, at and above the bus
    made.host.uncached_read_bytes = int(number(1, 16));
    made.host.division_nanoseconds = number(0, 100);
    made.host.write_bytes_per_clock = int(number(1, 16));
    if (chance(0.2)) made.numbers.frame = FrameFormat::float32;  // lines over several memory channels
    if (chance(0.2)) made.numbers.depth = DepthFormat::z16;
    if (chance(0.1)) made.memory.row_bytes = 65536;  // the ends of the ranges
    if (chance(0.1)) made.memory.interleave_bytes = made.memory.row_bytes;
    return made;
  }

 private:
  std::uint32_t number(std::uint32_t least, std::uint32_t most) {
    return least + next_() % (most - least + 1);
  }
  bool chance(double probability) { return number(0, 99) >= 100 * (1 - probability); }

  void add_draw(RandomTrace& made, bool has_color) {
    Draw draw;
    draw.vertex_program = number(0, 1);
    draw.vertex_stride = number(1, 20) * 4;
    draw.first_index = 3 * number(0, 20);
    draw.index_count = 3 * number(0, 80);
    draw.index_buffer = 1;
    draw.state = {chance(0.7), chance(0.7),      has_color && chance(0.7),
                  chance(0.7), BlendFactor::one, BlendFactor::one};
    if (chance(0.7)) draw.pixel_program = 2;
    if (chance(0.7)) draw.texture = 0;
    if (made.trace.surfaces != 0 && chance(0.6)) {
      draw.target = number(0, 1);
      if (draw.target == 0) draw.source = 1;
      if (draw.target == 1) draw.state.depth_test = draw.state.depth_write = false;
    }
    DrawWork work;
    work.command = static_cast<std::uint32_t>(made.trace.commands.size());
    for (std::uint32_t i = 0; i < draw.index_count / 3; ++i) add_triangle(made.trace, draw, work);
    made.trace.commands.emplace_back(draw);
    made.work.push_back(work);
  }

  void add_triangle(const Trace& trace, const Draw& draw, DrawWork& work) {
    TriangleWork triangle;
    triangle.new_vertices = static_cast<std::uint8_t>(number(0, 3));
    for (std::uint32_t i = 0; i < triangle.new_vertices; ++i) work.shaded_vertices.push_back(number(0, 200));
    triangle.pieces = static_cast<std::uint8_t>(chance(0.8) ? 1 : number(0, 3));
    if (triangle.pieces == 0) {
      triangle.outcome = TriangleOutcome::behind_near;
    } else {
      triangle.quad_count = number(0, 12);
      triangle.tile_count = number(0, 5);
    }
    for (std::uint32_t i = 0; i < triangle.quad_count; ++i) {
      QuadWork quad;
      quad.x = static_cast<std::uint16_t>(number(0, (trace.width - 1) / 2));
      quad.y = static_cast<std::uint16_t>(number(0, (trace.height - 1) / 2));
      quad.covered = static_cast<std::uint8_t>(number(1, 15));
      quad.passed = static_cast<std::uint8_t>(quad.covered & number(0, 15));
      const bool sampled = binds_texture(draw) && draw.pixel_program && quad.passed != 0;
      quad.texel_block_count = static_cast<std::uint8_t>(sampled ? number(1, 4) : 0);
      for (int block = 0; block < quad.texel_block_count; ++block)
        work.texel_blocks.push_back(number(0, 255));
      work.quads.push_back(quad);
      triangle.quads_passed += quad.passed != 0;
    }
    work.triangles.push_back(triangle);
  }

  std::function<std::uint32_t()> next_;
};

// One draw of `triangles` triangles with three vertices and four quads each.
inline RandomTrace simple_trace(int triangles) {
  RandomTrace made = RandomMaker(1).trace();
  made.trace.width = made.trace.height = 64;
  made.trace.buffers = {{MemoryPlace::video, {}}, {MemoryPlace::video, {}}};
  Draw draw;
  draw.vertex_program = 1;
  draw.vertex_stride = 32;
  draw.index_buffer = 1;
  draw.index_count = static_cast<std::uint32_t>(3 * triangles);
  draw.state.blend = true;
  draw.pixel_program = 2;
  draw.texture = 0;
  DrawWork work;
  work.command = 1;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(triangles); ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) work.shaded_vertices.push_back(3 * i + k);
    work.triangles.push_back({4, 4, 1, 3, 1, TriangleOutcome::drawn});
    for (std::uint16_t k = 0; k < 4; ++k) {
      work.quads.push_back(
          {static_cast<std::uint16_t>((i + k) % 32), static_cast<std::uint16_t>(i % 32), 15, 15, 1});
      work.texel_blocks.push_back((7 * i + k) % 256);
    }
  }
  made.trace.commands = {Clear{}, draw};
  made.work = {work};
  return made;
}

}  // namespace splatscope::sim::testing
