#include "sim/units/raster/rasteriser.h"

#include <algorithm>

namespace splatscope::sim {

Rasteriser::Rasteriser(std::string name, Completion& completion, const Machine::Raster& spec,
                       int quads_per_clock)
    : DrawUnit(std::move(name), completion), spec_(spec), quads_per_clock_(quads_per_clock) {}

void Rasteriser::connect(Items& in, const QuadTargets& out) {
  in_ = &in;
  targets_ = out;
}

void Rasteriser::start(const DrawJob& job) {
  next_quad_ = 0;
  out_ = targets_.of(job);
  all_quads_ = uses_depth(*job.draw);
}

int Rasteriser::send(Cycle now) {
  int sent = 0;
  for (; sent < quads_per_clock_ && quads_left_ != 0; ++sent) {
    if (out_ && (all_quads_ || is_colored(job(), job().quads[next_quad_]))) {
      if (!out_->can_push(now)) break;
      out_->push(now, next_quad_);
    }
    if (on_quad_) on_quad_(now, job().quads[next_quad_]);
    ++next_quad_;
    --quads_left_;
  }
  quads_ += static_cast<std::uint64_t>(sent);
  return sent;
}

Step Rasteriser::advance(Cycle now) {
  if (!walking_) {
    if (!in_->can_pop(now)) return nothing_to_take(in_->next_visible());
    triangle_ = in_->pop(now);
    const TriangleWork& triangle = job().triangles[triangle_];
    quads_left_ = triangle.quad_count;
    tiles_left_ = std::max(triangle.tile_count, 1u);
    tiles_ += triangle.tile_count;
    empty_ += triangle.quad_count == 0;
    walking_ = true;
  }
  const bool in_tiles = tiles_left_ != 0;
  tiles_left_ -= std::min(tiles_left_, static_cast<std::uint32_t>(spec_.tiles_per_clock));
  const int sent = send(now);
  if (quads_left_ == 0 && tiles_left_ == 0) {
    walking_ = false;
    event(now, triangle_);
    item_done(now);
  } else if (sent == 0 && !in_tiles) {
    return blocked(out_->consumer(), out_->next_free());
  }
  return busy(now + 1);
}

std::vector<Statistic> Rasteriser::statistics(Cycle) const {
  return {{"quads", "quads", "2x2 quads with coverage", quads_},
          {"tiles", "tiles", "8x8-pixel tiles visited", tiles_},
          {"empty_triangles", "triangles", "that cover no pixel centre", empty_}};
}

std::string Rasteriser::state() const {
  return walking_ ? "triangle " + std::to_string(triangle_) + ", quads left " + std::to_string(quads_left_)
                  : "";
}

}  // namespace splatscope::sim
