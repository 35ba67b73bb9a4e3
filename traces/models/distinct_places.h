#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <set>
#include <span>
#include <vector>

#include "traces/models/sampler.h"

namespace splatscope::traces {

// A point at the position of an earlier one.
struct PlaceCopy {
  std::uint32_t point = 0;
  std::uint32_t of = 0;  // the first there
};

// The positions of points, each but once. Equal are positions whose three numbers are: -0 is 0.
class DistinctPlaces {
 public:
  explicit DistinctPlaces(std::span<const MeshSample> points);

  // The points that were at the position of another, by their number.
  const std::vector<PlaceCopy>& copies() const { return copies_; }
  // Makes it a position too; false where it was one.
  bool take(const glm::vec3& position);

 private:
  struct Less {
    bool operator()(const glm::vec3& a, const glm::vec3& b) const;
  };
  std::vector<glm::vec3> places_;  // sorted
  std::set<glm::vec3, Less> more_;
  std::vector<PlaceCopy> copies_;
};

// Moves copies, which are in order, behind the other points, and makes them copies in all.
void to_the_end(std::span<const PlaceCopy> copies, MeshSamples& samples);

}  // namespace splatscope::traces
