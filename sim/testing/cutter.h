#pragma once

#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include "model/work/work.h"

namespace splatscope::sim::testing {

// Cuts the work of draws into parts of up to `most` triangles, each in the place of the one before.
class Cutter {
 public:
  Cutter(std::span<const DrawWork> draws, std::size_t most, unsigned seed)
      : draws_(draws), count_(1, most), random_(seed) {}

  const DrawWork& next() {
    const DrawWork& draw = draws_[draw_];
    part_ = {};
    part_.command = draw.command;
    part_.sampled_runs_apart = draw.sampled_runs_apart;
    for (std::size_t left = count_(random_); left != 0 && triangle_ != draw.triangles.size(); --left) {
      const TriangleWork& triangle = draw.triangles[triangle_++];
      part_.triangles.push_back(triangle);
      move(draw.shaded_vertices, vertex_, triangle.new_vertices, part_.shaded_vertices);
      for (std::size_t quad = quad_; quad != quad_ + triangle.quad_count; ++quad)
        move(draw.texel_blocks, block_, draw.quads[quad].texel_block_count, part_.texel_blocks);
      move(draw.quads, quad_, triangle.quad_count, part_.quads);
      for (; tile_ != draw.clear_tiles.size() && draw.clear_tiles[tile_].triangle < triangle_; ++tile_)
        part_.clear_tiles.push_back(draw.clear_tiles[tile_]);
    }
    if (triangle_ == draw.triangles.size()) {
      ++draw_;
      triangle_ = vertex_ = quad_ = block_ = tile_ = 0;
    }
    return part_;
  }
  bool is_at_the_end() const { return draw_ == draws_.size(); }

 private:
  template <class T>
  static void move(const std::vector<T>& from, std::size_t& at, std::size_t count, std::vector<T>& to) {
    for (; count != 0; --count) to.push_back(from[at++]);
  }

  std::span<const DrawWork> draws_;
  std::uniform_int_distribution<std::size_t> count_;
  std::mt19937 random_;
  std::size_t draw_ = 0, triangle_ = 0, vertex_ = 0, quad_ = 0, block_ = 0, tile_ = 0;
  DrawWork part_;
};

}  // namespace splatscope::sim::testing
