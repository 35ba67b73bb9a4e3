#include "traces/models/sampler.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <queue>

#include "model/stop.h"
#include "traces/models/distinct_places.h"
#include "traces/models/relax.h"
#include "traces/models/triangle.h"
#include "traces/models/voxels.h"

namespace splatscope::traces {
namespace {

constexpr std::size_t kPlaces = 4;  // tried for each point
constexpr std::uint32_t kNone = VoxelIndex::kNone;

// SplitMix64: neighbouring numbers give unrelated bits.
std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

double distance2(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = a - b;
  return glm::dot(d, d);
}

// Projection onto the surface inside the cell. A triangle goes on beyond its cell, and the closest point may
// lie there; going back and forth between two convex bodies that meet leads to where they do.
MeshSample project(const TriangleCorners& mesh, const SampledCell& cell, const glm::dvec3& place) {
  constexpr int kTries = 4;
  const glm::dvec3 half = 0.5 * cell.dimensions;
  MeshSample found = closest_sample(mesh, cell.triangles, place);
  for (int i = 1; i < kTries; ++i) {
    const glm::dvec3 point(found.position);
    const glm::dvec3 inside = glm::clamp(point, cell.center - half, cell.center + half);
    if (inside == point) break;
    found = closest_sample(mesh, cell.triangles, inside);
  }
  return found;
}

class Sampler {
 public:
  Sampler(const Mesh& mesh, const SamplerOptions& options)
      : mesh_(corners_of(mesh)),
        options_(options),
        voxels_(voxelize(mesh_, options.depth, options.count)),
        index_(voxels_) {
    const std::size_t cells = voxels_.cells.size();
    states_.resize(cells);
    places_.resize(cells * kPlaces);
    around_.resize(cells);
    sampled_.resize(voxels_.triangles.size());
    tbb::parallel_for(std::size_t{0}, cells, [&](std::size_t i) {
      stop_if_asked();
      states_[i].unsampled = static_cast<std::uint32_t>(voxels_.triangles_of(i).size());
      const SampledCell cell = seen(i);
      for (std::size_t p = 0; p < kPlaces; ++p) places_[i * kPlaces + p] = try_place(cell, p);
      around_[i] = find_around(i);
    });
    points_.reserve(options.count);
    next_.reserve(options.count);
  }

  MeshSamples run(const std::function<void(double)>& progress) {
    constexpr std::size_t kReport = 4096;  // points between two
    std::vector<Entry> entries;
    entries.reserve(states_.size());
    for (std::size_t i = 0; i < states_.size(); ++i) entries.push_back(entry(i));
    std::priority_queue heap(std::less<>(), std::move(entries));
    while (points_.size() < options_.count) {
      stop_if_asked();
      if (progress && points_.size() % kReport == 0)
        progress(static_cast<double>(points_.size()) / static_cast<double>(options_.count));
      const std::uint32_t cell = heap.top().cell;
      heap.pop();
      take_point(cell);
      heap.push(entry(cell));
    }
    MeshSamples samples{in_order(), {}};
    relax(mesh_, voxels_, index_, options_.relaxations, samples.points);
    part(samples);
    return samples;
  }

 private:
  struct State {
    std::uint32_t unsampled = 0;
    std::uint32_t samples = 0;
    std::uint32_t last = kNone;   // of its points; the others by next_
    std::uint32_t taken = kNone;  // of its places, the one that was taken last
  };

  struct Entry {
    double priority;
    std::uint32_t tie;  // by chance, so that what is left over at the end does not lie side by side
    std::uint32_t cell;
    bool operator<(const Entry& other) const {
      if (priority != other.priority) return priority < other.priority;
      return tie != other.tie ? tie < other.tie : cell < other.cell;
    }
  };

  SampledCell seen(std::size_t i) const {
    return {voxels_.center(i),    voxels_.size,       voxels_.triangles_of(i),
            states_[i].unsampled, states_[i].samples, i};
  }

  Entry entry(std::size_t i) const {
    return {options_.priority(seen(i)), static_cast<std::uint32_t>(scramble(i)),
            static_cast<std::uint32_t>(i)};
  }

  MeshSample try_place(const SampledCell& cell, std::size_t index) const {
    const glm::dvec3 place = options_.distribution(cell, index) - 0.5;
    return project(mesh_, cell, cell.center + place * cell.dimensions);
  }

  // A cell and those around it, kNone after the last.
  using Around = std::array<std::uint32_t, 28>;

  Around find_around(std::size_t i) const {
    Around around;
    std::size_t count = 0;
    const glm::uvec3 at = voxels_.cells[i];
    for (unsigned z = 0; z < 3; ++z) {
      for (unsigned y = 0; y < 3; ++y) {
        for (unsigned x = 0; x < 3; ++x) {
          const glm::uvec3 place = at + glm::uvec3(x, y, z) - 1u;  // below 0 wraps to where no cell is
          const std::uint32_t found = index_.at(place);
          if (found != kNone) around[count++] = found;
        }
      }
    }
    around[count] = kNone;
    return around;
  }

  // Squared distance to the nearest point in those cells; of a cell with more than kCompared, where parts of
  // the mesh lie so far apart that all of one is in few cells, to the last ones.
  double room(const Around& around, const MeshSample& place) const {
    constexpr int kCompared = 256;
    double least = std::numeric_limits<double>::infinity();
    const glm::dvec3 position(place.position);
    for (std::size_t n = 0; around[n] != kNone; ++n) {
      std::uint32_t p = states_[around[n]].last;
      for (int i = 0; i < kCompared && p != kNone; ++i, p = next_[p])
        least = std::min(least, distance2(glm::dvec3(points_[p].position), position));
    }
    return least;
  }

  void take_point(std::uint32_t i) {
    State& state = states_[i];
    // Another place for the one that was taken; few cells have a second turn, so not before it comes.
    if (state.taken != kNone)
      places_[i * kPlaces + state.taken] = try_place(seen(i), kPlaces + state.samples - 1);
    double most = -1;
    for (std::size_t p = 0; p < kPlaces; ++p) {
      const double distance = room(around_[i], places_[i * kPlaces + p]);
      if (!(distance > most)) continue;
      most = distance;
      state.taken = static_cast<std::uint32_t>(p);
    }
    points_.push_back(places_[i * kPlaces + state.taken]);
    next_.push_back(state.last);
    state.last = static_cast<std::uint32_t>(points_.size() - 1);
    ++state.samples;
    mark_sampled(i, points_.back());
  }

  void mark_sampled(std::uint32_t i, const MeshSample& point) {
    State& state = states_[i];
    if (state.unsampled == 0) return;
    const auto triangles = voxels_.triangles_of(i);
    const double reach = 0.5 * std::max({voxels_.size.x, voxels_.size.y, voxels_.size.z});
    const glm::dvec3 position(point.position);
    for (std::size_t n = 0; n < triangles.size(); ++n) {
      char& sampled = sampled_[voxels_.first[i] + n];
      if (sampled != 0) continue;
      const Triangle t = triangle_of(mesh_, triangles[n]);
      const bool near = distance2(point_at(t, closest_point(t, position)), position) < reach * reach;
      if (!near && triangles[n] != point.triangle) continue;
      sampled = 1;
      --state.unsampled;
    }
  }

  std::vector<MeshSample> in_order() const {
    std::vector<MeshSample> out;
    out.reserve(points_.size());
    for (const State& state : states_)
      for (std::uint32_t p = state.last; p != kNone; p = next_[p]) out.push_back(points_[p]);
    return out;
  }

  // Points meet in corners, which are closest to many places. All but the first go back to where they were
  // placed; or else to another place in the cell, or in any.
  void part(MeshSamples& samples) const {
    DistinctPlaces places(samples.points);
    if (places.copies().empty()) return;
    const std::vector<MeshSample> placed = in_order();
    std::vector<PlaceCopy> stuck;
    std::vector<std::uint32_t> tried(states_.size(), 0);  // places of a cell
    bool full = false;  // a long search found nothing: the mesh has no place left, or next to none
    std::size_t cell = 0, end = states_[0].samples;  // of the cell's points
    for (const PlaceCopy& copy : places.copies()) {
      stop_if_asked();
      while (copy.point >= end) end += states_[++cell].samples;
      MeshSample& point = samples.points[copy.point];
      if (places.take(placed[copy.point].position)) {
        point = placed[copy.point];
      } else if (full ||
                 !(settle(point, cell, tried, places) || settle_anywhere(point, copy.point, tried, places))) {
        full = true;
        stuck.push_back(copy);
      }
    }
    to_the_end(stuck, samples);
  }

  // At places of the cell that were not tried before.
  bool settle(MeshSample& point, std::size_t cell, std::vector<std::uint32_t>& tried,
              DistinctPlaces& places) const {
    constexpr std::size_t kTries = 64;
    const std::size_t first = kPlaces + states_[cell].samples;
    for (std::size_t i = 0; i < kTries; ++i) {
      const MeshSample place = try_place(seen(cell), first + tried[cell]++);
      if (!places.take(place.position)) continue;
      point = place;
      return true;
    }
    return false;
  }

  bool settle_anywhere(MeshSample& point, std::size_t number, std::vector<std::uint32_t>& tried,
                       DistinctPlaces& places) const {
    constexpr std::size_t kCells = 64;
    for (std::size_t i = 0; i < kCells; ++i) {
      stop_if_asked();
      if (settle(point, scramble(kCells * number + i) % states_.size(), tried, places)) return true;
    }
    return false;
  }

  const TriangleCorners mesh_;
  const SamplerOptions& options_;
  Voxels voxels_;
  VoxelIndex index_;
  std::vector<State> states_;
  std::vector<char> sampled_;  // of voxels_.triangles
  std::vector<Around> around_;
  std::vector<MeshSample> places_;  // kPlaces a cell, ready to be taken
  std::vector<MeshSample> points_;
  std::vector<std::uint32_t> next_;  // point of the same cell
};

}  // namespace

double unsampled_triangles(const SampledCell& cell) {
  constexpr double kEmpty = 1e12;  // more than there are triangles
  if (cell.samples == 0) return kEmpty + static_cast<double>(cell.unsampled);
  return cell.unsampled > 0 ? static_cast<double>(cell.unsampled) : -static_cast<double>(cell.samples);
}

// Roberts's R3: multiples of the powers of the root of x^4 = x + 1, modulo 1.
glm::dvec3 even_distribution(const SampledCell& cell, std::size_t index) {
  constexpr glm::dvec3 kStep{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  const std::uint64_t bits = scramble(~cell.number);
  const glm::dvec3 shift =
      glm::dvec3(bits & 0x1fffffu, bits >> 21 & 0x1fffffu, bits >> 42 & 0x1fffffu) / 2097152.0;
  return glm::fract(shift + static_cast<double>(index + 1) * kStep);
}

MeshSamples sample(const Mesh& mesh, const SamplerOptions& options,
                   const std::function<void(double)>& progress) {
  if (options.count == 0) return {};
  return Sampler(mesh, options).run(progress);
}

}  // namespace splatscope::traces
