#include "sim/units/primitive/primitive_assembly.h"

namespace splatscope::sim {
namespace {

constexpr std::uint64_t kReportEvery = 4096;  // triangles

}  // namespace

PrimitiveAssembly::PrimitiveAssembly(std::string name, Completion& completion, const Machine::Primitive& spec)
    : DrawUnit(std::move(name), completion), spec_(spec) {}

void PrimitiveAssembly::connect(Channel<std::uint8_t>& order, std::vector<Channel<VertexNumber>*> units,
                                Items& out) {
  order_ = &order;
  units_ = std::move(units);
  out_ = &out;
}

void PrimitiveAssembly::start(const DrawJob&) {
  triangle_ = 0;
  vertices_ = 0;
  next_mark_ = 0;
}

// One vertex a cycle, when the next triangle needs it.
bool PrimitiveAssembly::take_vertex(Cycle now) {
  if (vertices_ >= job().triangles[triangle_].new_vertices || !order_->can_pop(now)) return false;
  auto& unit = *units_[order_->front()];
  if (!unit.can_pop(now)) return false;
  order_->pop(now);
  unit.pop(now);
  ++vertices_;
  return true;
}

bool PrimitiveAssembly::assemble(Cycle now) {
  const TriangleWork& triangle = job().triangles[triangle_];
  if (free_from_ > now || vertices_ < triangle.new_vertices) return false;
  const bool drawn = triangle.pieces != 0;
  if (drawn) {
    if (!out_->can_push(now)) return false;
    out_->push(now, static_cast<std::uint32_t>(triangle_));
  }
  ++(drawn ? assembled_ : rejected_);
  const Cycle further = drawn ? triangle.pieces - 1u : 0u;
  clipped_ += further != 0;
  free_from_ =
      now + static_cast<Cycle>(spec_.clocks_per_triangle) + further * static_cast<Cycle>(spec_.clip_clocks);
  vertices_ -= triangle.new_vertices;
  event(now, triangle_);
  if (next_mark_ < job().marks.size() && job().marks[next_mark_] == triangle_) {
    ++next_mark_;
    tell_(now);
  }
  ++triangle_;
  item_done(free_from_ - 1);
  if (report_ && (assembled_ + rejected_) % kReportEvery == 0) report_(assembled_ + rejected_);
  return true;
}

Step PrimitiveAssembly::advance(Cycle now) {
  if (!has_work()) return free_from_ > now ? busy(free_from_) : idle();
  bool moved = assemble(now);
  if (has_work()) moved |= take_vertex(now);
  if (moved) return busy(now + 1);
  if (free_from_ > now) return busy(free_from_);
  if (vertices_ >= job().triangles[triangle_].new_vertices) {
    return blocked(out_->consumer(), out_->next_free());
  }
  if (!order_->can_pop(now)) return starved(order_->next_visible());
  return starved(units_[order_->front()]->next_visible());
}

std::vector<Statistic> PrimitiveAssembly::statistics(Cycle) const {
  return {{"assembled", "triangles", "passed to setup", assembled_},
          {"rejected", "triangles", "outside, behind, not finite or culled", rejected_},
          {"clipped", "triangles", "that clipping made more than one of, not culled", clipped_}};
}

std::string PrimitiveAssembly::state() const {
  return "triangle " + std::to_string(triangle_) + ", vertices " + std::to_string(vertices_);
}

}  // namespace splatscope::sim
