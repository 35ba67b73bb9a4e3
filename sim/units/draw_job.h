#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "model/command/commands.h"
#include "model/work/work.h"

namespace splatscope::sim {

// A place in a draw at which some of it was left out: of a sampled draw (`../fidelity/sampled.h`). Several
// can be at one place, in order.
struct Cut {
  std::uint32_t vertex = 0, quad = 0;   // the first ones after it
  std::vector<std::uint32_t> vertices;  // that were left out, of `DrawWork::shaded_vertices`
  std::vector<QuadWork> quads;          // that were left out
  std::vector<std::uint32_t> blocks;    // texel blocks of these
};

// Those of a draw, by their numbers, without those that all units have passed.
class Cuts {
 public:
  void clear() {
    forget(end_);
    begin_ = end_ = 0;
  }
  // A new one, of nothing, in memory of one that was forgotten.
  Cut& add(std::uint32_t vertex, std::uint32_t quad) {
    Cut& cut = held_.emplace_back();
    if (!forgotten_.empty()) {
      cut = std::move(forgotten_.back());
      forgotten_.pop_back();
    }
    cut.vertex = vertex;
    cut.quad = quad;
    ++end_;
    return cut;
  }
  void forget(std::uint64_t begin) {
    for (; begin_ < begin; ++begin_) {
      Cut& cut = forgotten_.emplace_back(std::move(held_.front()));
      cut.vertices.clear();
      cut.quads.clear();
      cut.blocks.clear();
      held_.pop_front();
    }
  }
  std::uint64_t begin() const { return begin_; }
  std::uint64_t end() const { return end_; }
  const Cut& operator[](std::uint64_t number) const { return held_[number - begin_]; }

 private:
  std::deque<Cut> held_;
  std::uint64_t begin_ = 0, end_ = 0;
  std::vector<Cut> forgotten_;
};

// Records of a draw, by their numbers in it: all of them one behind the other, or the last ones in a ring.
template <class T>
class Records {
 public:
  Records() = default;
  explicit Records(std::span<const T> all) : slots_(all.data()) {}
  // `mask`: one less than the ring's size, a power of two.
  Records(const T* ring, std::uint64_t mask) : slots_(ring), mask_(mask) {}

  const T& operator[](std::uint64_t number) const { return slots_[number & mask_]; }

 private:
  const T* slots_ = nullptr;
  std::uint64_t mask_ = ~std::uint64_t{0};
};

// How much of a draw's work there is.
struct DrawCounts {
  std::uint64_t triangles = 0;
  std::uint64_t shaded_vertices = 0;
  std::uint64_t triangles_set_up = 0;  // not rejected before setup
  std::uint64_t quads = 0;
  std::uint64_t colored_quads = 0;  // that go on to texture, pixel unit and blending

  DrawCounts& operator+=(const DrawCounts& more) {
    triangles += more.triangles;
    shaded_vertices += more.shaded_vertices;
    triangles_set_up += more.triangles_set_up;
    quads += more.quads;
    colored_quads += more.colored_quads;
    return *this;
  }
};

// Where the rest of a draw's work comes from.
class MoreWork {
 public:
  virtual ~MoreWork() = default;
  // The next part of it; waits where it is still being computed.
  virtual void take() = 0;
};

// A draw as the units take it: its work, and what is the same for all of it.
struct DrawJob {
  const Draw* draw = nullptr;
  std::uint32_t command = 0;         // its place in the trace
  bool textured = false;             // its quads go through the texture unit
  std::size_t vertex_program = 0;    // which of the programs of the vertex units
  std::uint64_t pixel_clocks = 1;    // a quad, of the pixel unit
  std::uint32_t vertex_address = 0;  // of base vertex 0, in the memory it lies in
  std::uint32_t index_address = 0;   // of the first index
  std::uint32_t texture_address = 0;
  std::uint64_t triangles_clipped = 0;   // into several pieces, of the whole draw also where it is sampled
  const Cuts* cuts = nullptr;            // null: nothing of it is left out
  std::span<const std::uint32_t> marks;  // triangles, in order, at which primitive assembly tells the time

  // What there is of the work so far. All of it, but where it comes in parts: then what some unit has passed
  // may be forgotten.
  Records<TriangleWork> triangles;
  Records<std::uint32_t> shaded_vertices;
  Records<QuadWork> quads;
  Records<std::uint32_t> texel_blocks;
  DrawCounts counts;
  std::uint64_t all_triangles = 0;  // that `counts` reaches at the end
  MoreWork* rest = nullptr;         // null: there is none

  bool is_complete() const { return rest == nullptr || counts.triangles == all_triangles; }
};

// Whether a quad goes on to texture, pixel unit and blending.
inline bool is_colored(const DrawJob& job, const QuadWork& quad) {
  return job.draw->state.color_write && quad.passed != 0;
}

}  // namespace splatscope::sim
