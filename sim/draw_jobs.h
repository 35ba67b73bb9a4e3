#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/command/commands.h"
#include "model/isa/program.h"
#include "model/machine/machine.h"
#include "model/work/work.h"
#include "sim/units/draw_job.h"
#include "sim/units/frame_lines.h"
#include "sim/units/vertex/vertex_unit.h"

namespace splatscope::sim {

// Where everything lies in memory: surfaces, textures and buffers one after the other, each at the start of a
// row of all banks. AGP buffers have their own addresses.
struct MemoryLayout {
  FrameLines color;
  FrameLines depth;
  std::uint32_t color_address = 0;  // of the frame; the off-screen surfaces follow it, line by line
  std::uint32_t depth_address = 0;
  std::vector<std::uint32_t> textures;
  std::vector<std::uint32_t> buffers;
};
MemoryLayout lay_out(const Trace& trace, const Machine& machine);

// What the draws of a trace need, over all of them.
struct Needs {
  bool agp = false;
  bool depth = false;    // some draw tests or writes depth
  bool color = false;    // some draw writes colour
  bool texture = false;  // some draw that writes colour samples a texture
};
Needs needs_of(const Trace& trace, std::span<const DrawJob> jobs);

// Clocks of a quad in the pixel unit, at least 1: the halves of its arithmetic instructions, colour and
// alpha, each for the slots that it takes, at `pixel.instructions_per_clock`. So a co-issued pair is as long
// as one instruction that writes both.
std::uint64_t clocks_per_quad(const isa::Program& program, const Machine::Pixel& spec);

// Whether the counts of a work record agree with each other, and with its draw where it is all of one.
bool adds_up(const DrawWork& work);
bool adds_up(const DrawWork& work, const Draw& draw);

// Triangles of a draw's work, or of a part of it, that were clipped into several pieces, and what else it
// holds.
std::uint64_t clipped_triangles(const DrawWork& work);
DrawCounts counts_of(const DrawWork& work, const Draw& draw);
// Gives the units all of a draw's work.
void show_all(DrawJob& job, const DrawWork& work);

// The vertex programs that the draws use, and the draws, in order. UserError where a program does not load.
struct PreparedDraws {
  std::vector<std::vector<IssueSlot>> vertex_programs;
  std::vector<DrawJob> jobs;
};
PreparedDraws prepare_draws(const Trace& trace, const Machine& machine, const MemoryLayout& layout);
// Gives a draw its work. ModelError where they do not fit together. `samples_suffice`: for an estimate.
void give_work(DrawJob& job, const DrawWork& work, bool samples_suffice = false);
// ModelError where there are more records, or fewer, than draws.
void expect_work_of_each_draw(const Trace& trace, std::span<const DrawWork> work);
// Both, for all draws.
PreparedDraws prepare_draws(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                            const MemoryLayout& layout);

}  // namespace splatscope::sim
