#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "model/command/commands.h"
#include "model/error.h"
#include "model/work/work.h"
#include "sim/kernel/channel.h"

namespace splatscope::sim {

// A place in a draw at which some of it was left out: of a sampled draw (`../fidelity/sampled.h`).
struct Cut {
  std::uint32_t vertex = 0, quad = 0;       // the first ones after it
  std::span<const std::uint32_t> vertices;  // that were left out, of `DrawWork::shaded_vertices`
  std::span<const QuadWork> quads;          // that were left out
  std::span<const std::uint32_t> blocks;    // texel blocks of these
};

// A draw as the units take it: its work, and what is the same for all of it.
struct DrawJob {
  const Draw* draw = nullptr;
  const DrawWork* work = nullptr;    // null before the draw begins, where it is computed beside
  std::uint32_t command = 0;         // its place in the trace
  bool textured = false;             // its quads go through the texture unit
  std::size_t vertex_program = 0;    // which of the programs of the vertex units
  std::uint64_t pixel_clocks = 1;    // a quad, of the pixel unit
  std::uint32_t vertex_address = 0;  // of base vertex 0, in the memory it lies in
  std::uint32_t index_address = 0;   // of the first index
  std::uint32_t texture_address = 0;
  std::uint64_t triangles_clipped = 0;   // into several pieces, of the whole draw also where it is sampled
  std::uint64_t triangles_set_up = 0;    // not rejected before setup
  std::uint64_t colored_quads = 0;       // quads that go on to texture, pixel unit and blending
  std::span<const Cut> cuts;             // in order
  std::span<const std::uint32_t> marks;  // triangles, in order, at which primitive assembly tells the time
};

// From unit to unit: numbers of the draw's triangles, or of its quads.
using Items = Channel<std::uint32_t>;

// Whether a quad goes on to texture, pixel unit and blending.
inline bool is_colored(const DrawJob& job, const QuadWork& quad) {
  return job.draw->state.color_write && quad.passed != 0;
}

// When the last unit has done its last item of a command. Finished at t is seen at t + 1.
class Completion {
 public:
  void set_waiter(Unit& waiter) { waiter_ = &waiter; }
  void start(Cycle now, std::uint32_t units) {
    outstanding_ = units;
    last_ = now;
    done_at_ = units == 0 ? now + 1 : kNever;
  }
  // `last`: the cycle in which a unit does the last of its work, this one or a later one.
  void finish(Cycle last) {
    last_ = std::max(last_, last);
    if (--outstanding_ == 0) {
      done_at_ = last_ + 1;
      waiter_->wake(done_at_);
    }
  }
  Cycle done_at() const { return done_at_; }

 private:
  Unit* waiter_ = nullptr;
  std::uint32_t outstanding_ = 0;
  Cycle last_ = 0;
  Cycle done_at_ = kNever;
};

// A unit that works on draws. The command processor, called last in a cycle, begins a draw; its items are
// counted down to tell *idle* (nothing left of this draw) from *starved* (some are still to come).
class DrawUnit : public Unit {
 public:
  DrawUnit(std::string name, Completion& completion) : Unit(std::move(name)), completion_(completion) {}

  // The number of items that the unit has to do of this draw; they are seen from the next cycle on.
  std::uint64_t begin(const DrawJob& job) {
    job_ = &job;
    next_cut_ = 0;
    remaining_ = start(job);
    return remaining_;
  }

 protected:
  virtual std::uint64_t start(const DrawJob& job) = 0;

  const DrawJob& job() const { return *job_; }
  bool has_work() const { return remaining_ != 0; }
  // `last`: the last cycle that the item takes of the unit, this one or a later one.
  void item_done(Cycle last) {
    if (remaining_ == 0) throw ModelError(name() + " has an item of no draw that it has begun");
    if (--remaining_ == 0) completion_.finish(last);
  }
  // Before item `number` is taken: pass(cut) for each cut before it that was not met yet. `first_after`:
  // which of the items a cut is told by.
  template <typename Pass>
  void pass_cuts(std::uint32_t Cut::*first_after, std::size_t number, Pass pass) {
    const std::span<const Cut> cuts = job_->cuts;
    for (; next_cut_ < cuts.size() && cuts[next_cut_].*first_after <= number; ++next_cut_)
      pass(cuts[next_cut_]);
  }
  Step nothing_to_take(Cycle next) const { return has_work() ? starved(next) : idle(next); }
  Completion& completion() { return completion_; }

 private:
  Completion& completion_;
  const DrawJob* job_ = nullptr;
  std::uint64_t remaining_ = 0;
  std::size_t next_cut_ = 0;  // of the draw
};

}  // namespace splatscope::sim
