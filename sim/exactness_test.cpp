#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/machine/parameters.h"
#include "sim/simulate.h"
#include "sim/testing/random_trace.h"
#include "sim/testing/shrink.h"

// Fidelity `cycle` against the referee, on random traces and machines. A failure is shrunk to a small one.
namespace splatscope::sim {
namespace {

using testing::Choices;
using testing::RandomMaker;
using testing::RandomTrace;

// What makers choose from; fewer and lower choices make a smaller trace and a plainer machine.
struct Case {
  Choices of_machine, of_trace;

  Machine machine() const { return RandomMaker(of_machine).machine(); }
  RandomTrace trace() const { return RandomMaker(of_trace).trace(); }
  bool operator==(const Case&) const = default;
};

rc::Gen<std::uint32_t> choice() {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint32_t>(0, 1u << 20));
}

// Half of a machine's parameters are the least: where all are any, the vertex units mostly are what all wait
// for, and what lies behind them is never full. A trace is small or large.
rc::Gen<Case> any_case() {
  const auto parameter = rc::gen::oneOf(rc::gen::just(std::uint32_t{0}), choice());
  const auto sizes = rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(100, 12000));
  const auto trace = [](std::size_t size) { return rc::gen::container<Choices>(size, choice()); };
  return rc::gen::noShrink(
      rc::gen::build<Case>(rc::gen::set(&Case::of_machine, rc::gen::container<Choices>(100, parameter)),
                           rc::gen::set(&Case::of_trace, rc::gen::mapcat(sizes, trace))));
}

// A case that fails too, as small as some tries make it.
Case shrunk(Case failing, const std::function<bool(const Case&)>& fails) {
  std::size_t tries = 20000;
  for (Case before; before != failing && tries > 0;) {
    before = failing;
    failing.of_trace = testing::shrunk(
        failing.of_trace,
        [&](const Choices& fewer) {
          return fails({failing.of_machine, fewer});
        },
        tries);
    failing.of_machine = testing::shrunk(
        failing.of_machine,
        [&](const Choices& fewer) {
          return fails({fewer, failing.of_trace});
        },
        tries);
  }
  return failing;
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

// What is wrong with a case; empty: nothing.
std::string failure_of(const Case& drawn) {
  const RandomTrace made = drawn.trace();
  const Machine machine = drawn.machine();
  try {
    return difference(simulate(made.trace, made.work, machine, Scheduler::skip_ahead),
                      simulate(made.trace, made.work, machine, Scheduler::referee));
  } catch (const std::exception& error) {
    return error.what();
  }
}

RC_GTEST_PROP(Exactness, TheRefereeAgreesWithSkipAheadInEveryEventAndEveryBook, ()) {
  const Case drawn = *any_case();
  RC_CLASSIFY(!drawn.trace().work.empty(), "draws");
  const std::string failure = failure_of(drawn);
  if (failure.empty()) return;
  std::cerr << failure << ", in a case that is made smaller now:\n" << drawn;
  std::ostringstream smallest;
  smallest << shrunk(drawn, [](const Case& smaller) { return !failure_of(smaller).empty(); });
  RC_FAIL("at smallest: " + smallest.str());
}

// A parameter that is always the same would never be tested.
TEST(Exactness, EveryParameterThatTellsTheTimeIsDrawn) {
  const auto value_of = [](const machine::Parameter& parameter, const Machine& machine) {
    return std::visit([&](const auto& field) { return static_cast<double>(field.get(machine)); },
                      parameter.field);
  };
  constexpr std::string_view kOfTheWork = "vertex.cache_entries";  // which the random work has decided
  std::vector<Machine> machines;
  for (unsigned seed = 0; seed < 200; ++seed) machines.push_back(RandomMaker(seed).machine());
  for (const machine::Parameter& parameter : machine::parameters()) {
    if (parameter.name.starts_with("numbers.") || parameter.name == kOfTheWork) continue;
    EXPECT_TRUE(std::ranges::any_of(machines, [&](const Machine& machine) {
      return value_of(parameter, machine) != value_of(parameter, machines[0]);
    })) << parameter.name;
  }
}

// As a bug behind a queue that takes some filling would.
TEST(Exactness, AFailureShrinksToWhatItTakes) {
  const auto quads = [](const Case& drawn) {
    std::size_t passed = 0;
    for (const DrawWork& work : drawn.trace().work)
      passed += static_cast<std::size_t>(
          std::ranges::count_if(work.quads, [](const QuadWork& quad) { return quad.passed != 0; }));
    return passed;
  };
  const auto fails = [&](const Case& drawn) {
    return quads(drawn) >= 40 && drawn.machine().setup.queue == 7;
  };
  std::mt19937 random(1);  // not of the machine, and so not another in every run
  Case failing;
  do {
    failing = {Choices(100), Choices(6000)};
    for (Choices* choices : {&failing.of_machine, &failing.of_trace})
      std::ranges::generate(*choices, [&] { return random() % (1u << 20); });
  } while (!fails(failing));
  const Case smallest = shrunk(failing, fails);
  EXPECT_EQ(quads(smallest), 40u);
  EXPECT_EQ(smallest.trace().work.size(), 1u);
  EXPECT_EQ(smallest.machine().setup.queue, 7);
  EXPECT_LE(std::ranges::count_if(smallest.of_machine, [](std::uint32_t choice) { return choice != 0; }), 1);
}

}  // namespace
}  // namespace splatscope::sim
