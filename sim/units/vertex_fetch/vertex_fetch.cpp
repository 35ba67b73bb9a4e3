#include "sim/units/vertex_fetch/vertex_fetch.h"

#include <algorithm>

namespace splatscope::sim {
namespace {

constexpr std::uint32_t kIndexBytes = 2;

}  // namespace

VertexFetch::VertexFetch(std::string name, Completion& completion, const Machine::Fetch& spec)
    : DrawUnit(std::move(name), completion),
      spec_(spec),
      cache_({spec.cache_lines, spec.cache_ways, static_cast<std::uint32_t>(spec.line_bytes),
              static_cast<std::uint32_t>(spec.line_bytes), spec.pending_vertices}) {}

void VertexFetch::connect(const Ports& video, const Ports& agp, std::vector<Channel<VertexNumber>*> units,
                          Channel<std::uint8_t>& order) {
  places_ports_[static_cast<std::size_t>(MemoryPlace::video)] = video;
  places_ports_[static_cast<std::size_t>(MemoryPlace::agp)] = agp;
  units_ = std::move(units);
  order_ = &order;
}

void VertexFetch::start(const DrawJob& job) {
  const Draw& draw = *job.draw;
  if (job.all_triangles == 0) return;
  index_port_ = places_ports_[static_cast<std::size_t>(places_[draw.index_buffer])].indices;
  cache_.connect(*places_ports_[static_cast<std::size_t>(places_[draw.vertex_buffer])].vertices,
                 job.vertex_address);
  cache_.invalidate();
  const auto line_bytes = static_cast<std::uint32_t>(spec_.line_bytes);
  const auto indices = static_cast<std::uint32_t>(3 * job.all_triangles);
  first_index_line_ = job.index_address / line_bytes;
  index_lines_ = (job.index_address + indices * kIndexBytes - 1) / line_bytes - first_index_line_ + 1;
  asked_ = taken_ = 0;
  triangle_ = vertex_ = ended_ = 0;
  new_vertices_ = line_ = delivered_ = 0;
  in_triangle_ = in_vertex_ = false;
  walk_from_ = 0;
}

const Unit* VertexFetch::no_unit_free(Cycle now) const {
  for (const auto* unit : units_) {
    if (unit->can_push(now)) return nullptr;
  }
  return &units_.front()->consumer();
}

bool VertexFetch::deliver(Cycle now) {
  if (cache_.empty() || !cache_.is_ready(now) || !order_->can_push(now)) return false;
  for (std::size_t unit = 0; unit < units_.size(); ++unit) {
    if (!units_[unit]->can_push(now)) continue;
    cache_.leave();
    units_[unit]->push(now, delivered_);
    order_->push(now, static_cast<std::uint8_t>(unit));
    event(now, delivered_++ * units_.size() + unit);
    return true;
  }
  return false;
}

// After the last vertex: word of the end to each vertex unit in turn.
bool VertexFetch::end_draw(Cycle now) {
  if (triangle_ != job().all_triangles || delivered_ != vertex_) return false;
  if (vertex_ == 0) ended_ = units_.size();
  bool moved = false;
  for (; ended_ < units_.size() && units_[ended_]->can_push(now); ++ended_) {
    units_[ended_]->push(now, kEndOfDraw);
    moved = true;
  }
  if (ended_ < units_.size()) return moved;
  item_done(now);
  return true;
}

bool VertexFetch::wants_index_line() const {
  return asked_ != index_lines_ && asked_ - taken_ != static_cast<std::uint32_t>(spec_.index_lines);
}

std::uint32_t VertexFetch::next_index_line() const {
  return (first_index_line_ + asked_) * static_cast<std::uint32_t>(spec_.line_bytes);
}

bool VertexFetch::read_indices(Cycle now) {
  if (!wants_index_line() || index_port_->in_the_way(now, next_index_line())) return false;
  index_port_->read(now, next_index_line(), static_cast<std::uint32_t>(spec_.line_bytes));
  ++asked_;
  return true;
}

// Whether the last index of the triangle is in a line that has come; earlier lines are let go.
bool VertexFetch::index_is_here(Cycle now) {
  const auto last = static_cast<std::uint32_t>(3 * triangle_ + 2);
  const std::uint32_t byte = job().index_address + last * kIndexBytes;
  const std::uint32_t line = byte / static_cast<std::uint32_t>(spec_.line_bytes) - first_index_line_;
  while (taken_ <= line) {
    if (taken_ == asked_ || index_port_->oldest_ready() > now) return false;
    index_port_->release_oldest();
    ++taken_;
  }
  return true;
}

// Takes the indices of a triangle, then gathers its new vertices.
bool VertexFetch::walk(Cycle now) {
  if (triangle_ == job().all_triangles) return false;
  if (walk_from_ > now) return false;
  if (!in_triangle_) {
    if (!index_is_here(now)) return false;
    in_triangle_ = true;
    indices_read_ += 3;
    new_vertices_ = job().triangles[triangle_].new_vertices;
  }
  bool moved = false;
  while (new_vertices_ != 0 && gather(now)) moved = true;
  if (new_vertices_ != 0) return moved;
  in_triangle_ = false;
  ++triangle_;
  walk_from_ = now + static_cast<Cycle>((3 + spec_.indices_per_clock - 1) / spec_.indices_per_clock);
  item_done(now);
  return true;
}

VertexFetch::Lines VertexFetch::lines_of(std::uint32_t vertex) const {
  const std::uint32_t stride = job().draw->vertex_stride, first = vertex * stride;
  const auto line_bytes = static_cast<std::uint32_t>(spec_.line_bytes);
  return {first / line_bytes, (first + std::max(stride, 1u) - 1) / line_bytes + 1};
}

// What the draw left out passes through the tags.
void VertexFetch::pass(const Cut& cut) {
  for (const std::uint32_t vertex : cut.vertices) {
    const Lines lines = lines_of(vertex);
    for (std::uint32_t line = lines.first; line < lines.end; ++line) cache_.pass(line, false);
  }
}

// Asks for the lines of the next new vertex, which then waits for them.
bool VertexFetch::gather(Cycle now) {
  if (!cache_.has_room()) return false;
  const Lines lines = lines_of(job().shaded_vertices[vertex_]);
  if (!in_vertex_) {
    pass_cuts(&Cut::vertex, vertex_, [this](const Cut& cut) { pass(cut); });
    line_ = lines.first;
    in_vertex_ = true;
  }
  for (; line_ < lines.end; ++line_) {
    in_the_way_ = cache_.touch(now, line_, true, false);
    if (in_the_way_) return false;
  }
  in_vertex_ = false;
  cache_.enter(static_cast<std::uint32_t>(vertex_++));
  ++vertices_read_;
  --new_vertices_;
  return true;
}

Step VertexFetch::advance(Cycle now) {
  if (!has_work()) return idle();
  in_the_way_ = nullptr;
  bool moved = deliver(now);
  moved |= read_indices(now);
  moved |= walk(now);
  moved |= end_draw(now);
  return moved ? busy(now + 1) : waiting(now);
}

// Nothing could be moved: why, from the end of the unit to its beginning.
Step VertexFetch::waiting(Cycle now) {
  Cycle next = walk_from_ > now ? walk_from_ : kNever;
  if (in_the_way_) next = std::min(next, cache_.next_try());
  if (wants_index_line()) next = std::min(next, index_port_->next_free(next_index_line()));
  if (taken_ != asked_) {
    if (index_port_->oldest_ready() == kNever) index_port_->await_oldest();
    if (index_port_->oldest_ready() > now) next = std::min(next, index_port_->oldest_ready());
  }
  if (!cache_.empty()) {
    if (!cache_.is_ready(now)) return blocked(cache_.server(), std::min(next, cache_.next_ready()));
    for (const auto* unit : units_) next = std::min(next, unit->next_free());
    if (const Unit* unit = no_unit_free(now)) return blocked(*unit, next);
    return blocked(order_->consumer(), std::min(next, order_->next_free()));
  }
  if (triangle_ == job().all_triangles) {
    for (const auto* unit : units_) next = std::min(next, unit->next_free());
    return blocked(units_[ended_]->consumer(), next);
  }
  if (in_the_way_) return blocked(*in_the_way_, next);
  if (walk_from_ > now) return busy(next);
  if (taken_ == asked_) {  // the last line read was let go, and the next has not been asked for
    const Unit* unit = index_port_->in_the_way(now, next_index_line());
    return unit ? blocked(*unit, next) : busy(now + 1);
  }
  return blocked(index_port_->oldest_server(), next);
}

std::vector<Statistic> VertexFetch::statistics(Cycle) const {
  return {{"indices", "indices", "indices taken", indices_read_},
          {"vertices", "vertices", "vertices read", vertices_read_},
          {"line_touches", "lines", "lines of vertices looked up", cache_.touches()},
          {"line_misses", "lines", "lines of vertices read from memory", cache_.misses()}};
}

std::string VertexFetch::state() const {
  return "triangle " + std::to_string(triangle_) + ", vertices delivered " + std::to_string(delivered_) +
         " of " + std::to_string(vertex_) + ", index lines taken " + std::to_string(taken_) + " of " +
         std::to_string(asked_) + " asked for";
}

}  // namespace splatscope::sim
