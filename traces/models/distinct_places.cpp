#include "traces/models/distinct_places.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <tuple>

#include "model/stop.h"

namespace splatscope::traces {
namespace {

auto key(const glm::vec3& p) {
  return std::tie(p.x, p.y, p.z);
}

struct Placed {
  glm::vec3 position;
  std::uint32_t point;
};

}  // namespace

bool DistinctPlaces::Less::operator()(const glm::vec3& a, const glm::vec3& b) const {
  return key(a) < key(b);
}

DistinctPlaces::DistinctPlaces(std::span<const MeshSample> points) {
  std::vector<Placed> placed(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) placed[i] = {points[i].position, i};
  tbb::parallel_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    stop_if_asked();  // the only place of ours in the sorting
    return key(a.position) != key(b.position) ? key(a.position) < key(b.position) : a.point < b.point;
  });
  places_.reserve(points.size());
  std::uint32_t first = 0;  // at the last position
  for (const Placed& p : placed) {
    if (!places_.empty() && places_.back() == p.position) {
      copies_.push_back({p.point, first});
    } else {
      places_.push_back(p.position);
      first = p.point;
    }
  }
  std::ranges::sort(copies_, {}, &PlaceCopy::point);
}

bool DistinctPlaces::take(const glm::vec3& position) {
  return !std::ranges::binary_search(places_, position, Less{}) && more_.insert(position).second;
}

void to_the_end(std::span<const PlaceCopy> copies, MeshSamples& samples) {
  if (copies.empty()) return;
  std::vector<MeshSample> points;
  points.reserve(samples.points.size());
  std::vector<std::uint32_t> number(samples.points.size());  // after the move
  auto copy = copies.begin();
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    if (copy != copies.end() && copy->point == i) {
      ++copy;
      continue;
    }
    number[i] = static_cast<std::uint32_t>(points.size());
    points.push_back(samples.points[i]);
  }
  for (const PlaceCopy& c : copies) {
    samples.copy_of.push_back(number[c.of]);
    points.push_back(points[number[c.of]]);
  }
  samples.points = std::move(points);
}

}  // namespace splatscope::traces
