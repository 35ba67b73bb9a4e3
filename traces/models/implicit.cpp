#include "traces/models/implicit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>

#include "kernels/bounds.h"
#include "model/stop.h"

namespace splatscope::traces {
namespace {

constexpr int kBlock = 8;  // cells along an edge of what is looked at in one go

double distance(const Bone& bone, const glm::dvec3& point) {
  const glm::dvec3 along = bone.b - bone.a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? glm::clamp(glm::dot(point - bone.a, along) / length2, 0.0, 1.0) : 0;
  glm::dvec3 off = point - (bone.a + t * along);
  const double radius = glm::mix(bone.radius_a, bone.radius_b, t);
  const double round = glm::length(off) - radius;
  if (bone.thinness == 1) return round;
  off += (bone.thinness - 1) * glm::dot(off, bone.flat) * bone.flat;
  return std::max(round, (glm::length(off) - radius) / bone.thinness);  // the blade lies in the round bone
}

// The minimum, rounded off where the two differ by less than `blend` (Quilez).
double melt(double a, double b, double blend) {
  const double near = blend > 0 ? std::max(blend - std::abs(a - b), 0.0) / blend : 0;
  return std::min(a, b) - 0.25 * near * near * blend;
}

// The bones, in their order, that the surface within `reach` of `center` may depend on; none where it is not
// there.
Body bones_near(const Body& body, const glm::dvec3& center, double reach) {
  constexpr double kSteepest = 1.5;  // the distances grow by no more than this per unit of way
  double least = std::numeric_limits<double>::infinity(), blend = 0;
  for (const Bone& bone : body) {
    least = std::min(least, distance(bone, center));
    blend = std::max(blend, bone.blend);
  }
  Body near;
  for (const Bone& bone : body)
    if (distance(bone, center) <= least + 2 * kSteepest * reach + blend) near.push_back(bone);
  if (std::abs(distance(near, center)) > kSteepest * reach) near.clear();  // all inside or all outside
  return near;
}

std::uint64_t key(const glm::ivec3& cell) {
  const auto bits = [](int i) { return static_cast<std::uint64_t>(i + (1 << 20)); };
  return bits(cell.x) | bits(cell.y) << 21 | bits(cell.z) << 42;
}

std::uint32_t part_at(const Body& body, const glm::dvec3& point) {
  const auto nearest =
      std::ranges::min_element(body, {}, [&](const Bone& bone) { return distance(bone, point); });
  return nearest->part;
}

// What one block adds to the mesh.
struct Patch {
  std::vector<std::uint64_t> cells;  // that the surface passes through, with a vertex in each
  std::vector<glm::vec3> positions, normals;
  std::vector<std::uint32_t> parts;
  std::vector<std::array<std::uint64_t, 4>> quads;  // of the cells around an edge that crosses the surface
};

class Block {
 public:
  Block(const Body& near, const glm::ivec3& first, double cell) : near_(near), first_(first), cell_(cell) {
    for (int i = 0; i < kCorners; ++i) values_[static_cast<std::size_t>(i)] = distance(near_, at(corner(i)));
  }

  Patch patch() const {
    Patch out;
    for (int z = 0; z < kBlock; ++z)
      for (int y = 0; y < kBlock; ++y)
        for (int x = 0; x < kBlock; ++x) {
          add_vertex({x, y, z}, out);
          add_quads({x, y, z}, out);
        }
    return out;
  }

 private:
  static constexpr int kSide = kBlock + 1;
  static constexpr int kCorners = kSide * kSide * kSide;

  static glm::ivec3 corner(int i) { return {i % kSide, i / kSide % kSide, i / (kSide * kSide)}; }
  glm::dvec3 at(const glm::dvec3& place) const { return cell_ * (glm::dvec3(first_) + place); }
  double value(const glm::ivec3& p) const {
    return values_[static_cast<std::size_t>((p.z * kSide + p.y) * kSide + p.x)];
  }

  glm::dvec3 gradient(const glm::dvec3& p) const {
    const double h = 0.1 * cell_;
    glm::dvec3 out;
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0);
      step[axis] = h;
      out[axis] = (distance(near_, p + step) - distance(near_, p - step)) / (2 * h);
    }
    return out;
  }

  // In the middle of where the cell's edges cross the surface, then moved onto it.
  void add_vertex(const glm::ivec3& cell, Patch& out) const {
    glm::dvec3 sum(0);
    int crossings = 0;
    for (int edge = 0; edge < 12; ++edge) {
      const int axis = edge / 4;
      glm::ivec3 from = cell;
      from[(axis + 1) % 3] += edge & 1;
      from[(axis + 2) % 3] += edge >> 1 & 1;
      glm::ivec3 to = from;
      ++to[axis];
      const double a = value(from), b = value(to);
      if ((a < 0) == (b < 0)) continue;
      glm::dvec3 crossing(from);
      crossing[axis] += a / (a - b);
      sum += crossing;
      ++crossings;
    }
    if (crossings == 0) return;
    glm::dvec3 p = at(sum / static_cast<double>(crossings));
    const glm::dvec3 slope = gradient(p);
    const double slope2 = std::max(glm::dot(slope, slope), 0.25);
    p -= glm::clamp(distance(near_, p) / slope2, -0.5 * cell_, 0.5 * cell_) * slope;
    out.cells.push_back(key(first_ + cell));
    out.positions.emplace_back(p);
    out.normals.emplace_back(gradient(p));
    out.parts.push_back(part_at(near_, p));
  }

  // For each edge from the cell's first corner that crosses the surface: a quad of the four cells around it.
  void add_quads(const glm::ivec3& cell, Patch& out) const {
    for (int axis = 0; axis < 3; ++axis) {
      glm::ivec3 to = cell;
      ++to[axis];
      const bool inside = value(cell) < 0;
      if (inside == (value(to) < 0)) continue;
      glm::ivec3 u(0), v(0);
      u[(axis + 1) % 3] = 1;
      v[(axis + 2) % 3] = 1;
      const glm::ivec3 c = first_ + cell;
      std::array quad{key(c - u - v), key(c - v), key(c), key(c - u)};
      if (!inside) std::swap(quad[1], quad[3]);  // the front is outside
      out.quads.push_back(quad);
    }
  }

  const Body& near_;
  glm::ivec3 first_;
  double cell_;
  std::array<double, kCorners> values_;
};

Mesh join(const std::vector<Patch>& patches) {
  Mesh mesh;
  std::vector<std::uint32_t> part;  // of each vertex
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of;
  for (const Patch& patch : patches) {
    for (std::size_t i = 0; i < patch.cells.size(); ++i) {
      vertex_of.emplace(patch.cells[i], static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(patch.positions[i]);
      mesh.normals.push_back(patch.normals[i]);
      part.push_back(patch.parts[i]);
    }
  }
  for (const Patch& patch : patches) {
    for (const auto& quad : patch.quads) {
      std::array<std::uint32_t, 4> v;
      for (std::size_t i = 0; i < 4; ++i) v[i] = vertex_of.at(quad[i]);
      for (const std::array<std::uint32_t, 3> t :
           {std::array{v[0], v[1], v[2]}, std::array{v[0], v[2], v[3]}}) {
        mesh.triangles.push_back(t);
        mesh.parts.push_back(part[t[0]]);
      }
    }
  }
  return mesh;
}

}  // namespace

double distance(std::span<const Bone> body, const glm::dvec3& point) {
  double total = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < body.size();) {
    const Bone& first = body[i];
    double limb = distance(first, point);
    for (++i; i < body.size() && body[i].limb == first.limb; ++i)
      limb = std::min(limb, distance(body[i], point));
    total = melt(total, limb, first.blend);
  }
  return total;
}

void add_limb(Body& body, std::span<const Vertebra> spine, const Flesh& flesh, int steps) {
  const std::size_t limb = body.size();
  const auto at = [&](std::size_t i, double t) {
    const Vertebra &before = spine[i > 0 ? i - 1 : 0], &from = spine[i], &to = spine[i + 1];
    const Vertebra& after = spine[std::min(i + 2, spine.size() - 1)];
    const auto curve = [t](auto p, auto q, auto r, auto s) {
      return 0.5 * (2.0 * q + t * (r - p) + t * t * (2.0 * p - 5.0 * q + 4.0 * r - s) +
                    t * t * t * (3.0 * q - p - 3.0 * r + s));
    };
    return Vertebra{curve(before.position, from.position, to.position, after.position),
                    std::max(curve(before.radius, from.radius, to.radius, after.radius),
                             std::min(from.radius, to.radius))};
  };
  for (std::size_t i = 0; i + 1 < spine.size(); ++i) {
    for (int step = 0; step < steps; ++step) {
      const Vertebra from = at(i, static_cast<double>(step) / steps);
      const Vertebra to = at(i, static_cast<double>(step + 1) / steps);
      body.push_back({from.position, to.position, from.radius, to.radius, flesh.part, flesh.blend, flesh.flat,
                      flesh.thinness, limb});
    }
  }
}

Mesh surface_of(const Body& body, double cell) {
  kernels::Box box;
  for (const Bone& bone : body) {
    const double reach = std::max(bone.radius_a, bone.radius_b) + bone.blend + 2 * cell;
    for (const glm::dvec3& end : {bone.a, bone.b}) box.add(end, glm::dvec3(reach));
  }
  const double size = kBlock * cell;
  const glm::ivec3 first(glm::floor(box.low / size)), last(glm::floor(box.high / size));
  const glm::ivec3 count = last - first + 1;
  std::vector<Patch> patches(static_cast<std::size_t>(count.x * count.y * count.z));
  const double reach = 0.5 * std::sqrt(3.0) * (size + 2 * cell);
  tbb::parallel_for(0, count.z, [&](int z) {
    for (int y = 0; y < count.y; ++y) {
      stop_if_asked();
      for (int x = 0; x < count.x; ++x) {
        const glm::ivec3 block = first + glm::ivec3(x, y, z);
        const Body near = bones_near(body, size * (glm::dvec3(block) + 0.5), reach);
        if (near.empty()) continue;
        patches[static_cast<std::size_t>((z * count.y + y) * count.x + x)] =
            Block(near, kBlock * block, cell).patch();
      }
    }
  });
  return join(patches);
}

}  // namespace splatscope::traces
