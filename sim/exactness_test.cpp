#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "sim/simulate.h"
#include "sim/testing/random_trace.h"

// Fidelity `cycle` against the referee, on random traces and machines. A failure is shrunk to a smallest one.
namespace splatscope::sim {
namespace {

using testing::RandomMaker;
using testing::RandomTrace;

// What a maker chooses from; fewer and lower choices make a smaller trace and a plainer machine.
using Choices = std::vector<std::uint32_t>;

struct Case {
  Choices of_machine, of_trace;

  Machine machine() const { return RandomMaker(of_machine).machine(); }
  RandomTrace trace() const { return RandomMaker(of_trace).trace(); }
};

rc::Gen<Choices> choices(int most) {
  const auto one = rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint32_t>(0, 1u << 20));
  return rc::gen::resize(most, rc::gen::container<Choices>(one));
}

rc::Gen<Case> any_case() {
  return rc::gen::build<Case>(rc::gen::set(&Case::of_machine, choices(100)),
                              rc::gen::set(&Case::of_trace, choices(6000)));
}

void show(std::ostream& out, const Draw& draw, const DrawWork& work) {
  const DrawState& state = draw.state;
  out << "  draw: vertex program " << draw.vertex_program << ", stride " << draw.vertex_stride
      << (draw.pixel_program ? ", pixel program" : "") << (draw.texture ? ", texture" : "")
      << (state.depth_test ? ", depth test" : "") << (state.depth_write ? ", depth write" : "")
      << (state.color_write ? ", colour write" : "") << (state.blend ? ", blending" : "") << ", first index "
      << draw.first_index << "\n";
  const QuadWork* quad = work.quads.data();
  for (const TriangleWork& triangle : work.triangles) {
    out << "    triangle: " << int{triangle.new_vertices} << " new vertices, " << int{triangle.pieces}
        << " pieces, " << triangle.tile_count << " tiles";
    for (std::uint32_t i = 0; i < triangle.quad_count; ++i, ++quad) {
      out << ", quad (" << quad->x << ", " << quad->y << ") passed " << int{quad->passed} << " blocks "
          << int{quad->texel_block_count};
    }
    out << "\n";
  }
}

std::ostream& operator<<(std::ostream& out, const Case& shown) {
  const Machine plain;
  const Machine machine = shown.machine();
  const auto values = machine::describe(machine), defaults = machine::describe(plain);
  out << "machine:";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].value != defaults[i].value) out << " " << values[i].name << "=" << values[i].value;
  }
  const RandomTrace made = shown.trace();
  out << "\ntrace of " << made.trace.width << " x " << made.trace.height << ":\n";
  std::size_t draw = 0;
  for (const Command& command : made.trace.commands) {
    if (std::holds_alternative<Clear>(command)) out << "  clear\n";
    if (std::holds_alternative<NormalizeOnHost>(command)) out << "  normalise on the host\n";
    if (std::holds_alternative<Present>(command)) out << "  present\n";
    if (const Draw* body = std::get_if<Draw>(&command)) show(out, *body, made.work[draw++]);
  }
  return out;
}

// The first thing that two results do not agree in; empty: none.
std::string difference(const Result& a, const Result& b) {
  if (a.cycles != b.cycles) return "cycles " + std::to_string(a.cycles) + " and " + std::to_string(b.cycles);
  if (a.command_ends != b.command_ends) return "ends of commands";
  if (a.frame_cycles != b.frame_cycles) return "cycles of frames";
  if (a.units.size() != b.units.size()) return "number of units";
  for (std::size_t i = 0; i < a.units.size(); ++i) {
    const UnitBooks &x = a.units[i], &y = b.units[i];
    if (x.busy + x.starved + x.blocked + x.idle != a.cycles) return "sum of the books of " + x.name;
    if (x.busy != y.busy || x.starved != y.starved || x.idle != y.idle || x.blocked_by != y.blocked_by)
      return "books of " + x.name;
  }
  if (a.statistics.size() != b.statistics.size()) return "number of statistics";
  for (std::size_t i = 0; i < a.statistics.size(); ++i) {
    if (a.statistics[i].value != b.statistics[i].value)
      return a.statistics[i].unit_name + "." + a.statistics[i].name;
  }
  return a.event_hash == b.event_hash ? "" : "event hash alone";
}

RC_GTEST_PROP(Exactness, TheRefereeAgreesWithSkipAheadInEveryEventAndEveryBook, ()) {
  const Case drawn = *any_case();
  const RandomTrace made = drawn.trace();
  const Machine machine = drawn.machine();
  RC_CLASSIFY(!made.work.empty(), "draws");
  const Result fast = simulate(made.trace, made.work, machine, Scheduler::skip_ahead);
  const Result dull = simulate(made.trace, made.work, machine, Scheduler::referee);
  RC_ASSERT(difference(fast, dull) == "");
}

}  // namespace
}  // namespace splatscope::sim
