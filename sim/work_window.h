#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "sim/simulate.h"
#include "sim/units/draw_unit.h"

namespace splatscope::sim {

// The last records of a draw, in a ring that grows to what is held at once.
template <class T>
class RecordRing {
 public:
  void clear() { begin_ = end_ = 0; }
  // Behind the last one.
  void append(std::span<const T> more);
  // Those before number `begin`, which has been reached.
  void forget(std::uint64_t begin) { begin_ = begin; }
  std::uint64_t end() const { return end_; }
  // Until the next append().
  Records<T> records() const { return {slots_.data(), slots_.size() - 1}; }

 private:
  std::vector<T> slots_;  // a power of two, or none
  std::uint64_t begin_ = 0, end_ = 0;
};

// The work of a draw that comes in parts while it is timed. What is held lies between the first unit of the
// pipeline and the last one, or the next item of a unit that has none before it: of a stretch that is hidden,
// all.
class WorkWindow {
 public:
  // `units`: that count a draw's items by its records, and look at them until an item is done. They outlive
  // it.
  explicit WorkWindow(std::span<const DrawUnit* const> units) : units_(units) {}

  // Empty, of the next draw, when all of the one before has been done. `triangles`: that are to be timed.
  void begin(DrawJob& job, std::uint64_t triangles, MoreWork& rest);
  // What comes next in the draw, as expect_part() has it.
  void add(const DrawWork& part);
  // What comes next is left out: a place for it.
  Cut& leave_out();

 private:
  // What a draw held at the end of a part.
  struct Ends {
    std::uint64_t triangles, shaded_vertices, quads, texel_blocks;
    std::vector<std::uint64_t> items;  // by unit
  };
  void forget();

  std::span<const DrawUnit* const> units_;
  DrawJob* job_ = nullptr;
  std::deque<Ends> parts_;  // that some unit may look at
  RecordRing<TriangleWork> triangles_;
  RecordRing<std::uint32_t> shaded_vertices_;
  RecordRing<QuadWork> quads_;
  RecordRing<std::uint32_t> texel_blocks_;
  Cuts cuts_;
};

// ModelError where a part is not one of this draw's work, of which so many triangles came before, or does not
// add up.
void expect_part(const DrawJob& job, const DrawWork& part, std::uint64_t triangles_before);

// All of a draw's work, one part after the other.
class WorkParts final : public MoreWork {
 public:
  WorkParts(const PartSource& next, std::span<const DrawUnit* const> units) : next_(next), window_(units) {}

  // Gives the job its first part, when all of the draw before has been done. ModelError: as expect_part().
  void begin(DrawJob& job);
  void take() override;

 private:
  const PartSource& next_;
  DrawJob* job_ = nullptr;
  WorkWindow window_;
};

}  // namespace splatscope::sim
