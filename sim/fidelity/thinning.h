#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/fidelity/stretches.h"
#include "sim/work_window.h"

namespace splatscope::sim {

// Triangles of a draw: `from` and those behind it before `to`.
struct Span {
  std::uint64_t from = 0, to = 0;
};

// The work of draws of which samples are left, one behind the other as if they were neighbours: so the
// pipeline runs on from each to the next, full and in its rhythm. It comes in parts.
class ThinParts final : public MoreWork {
 public:
  ThinParts(const PartSource& next, std::span<const DrawUnit* const> units) : next_(next), window_(units) {}

  // Gives the job its first part, when all of the draw before has been done. `kept`: in order, to the end of
  // the draw; empty: all of it. `stretches`: that are to count all of the draw, begun for it; or null.
  // ModelError: as expect_part().
  void begin(DrawJob& job, std::vector<Span> kept, Stretches* stretches);
  void take() override;

 private:
  struct Place {  // in the records of a part
    std::size_t triangle = 0, vertex = 0, quad = 0, block = 0;
  };
  Place find(std::size_t triangle) const;  // from `at_` on
  void next_part();
  void go_to(const Place& end);
  // Triangles of the part, from `at_` on.
  void leave_out(std::size_t triangle);
  void keep(std::size_t triangle);

  const PartSource& next_;
  WorkWindow window_;
  DrawJob* job_ = nullptr;
  std::vector<Span> kept_;
  std::size_t next_kept_ = 0;
  Stretches* stretches_ = nullptr;
  const DrawWork* part_ = nullptr;  // null: the next one is to be asked for
  std::uint64_t part_begin_ = 0;    // its first triangle
  Place at_;                        // in it
  DrawWork some_;                   // of it
};

}  // namespace splatscope::sim
