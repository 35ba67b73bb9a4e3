#pragma once

#include <vector>

#include "model/machine/machine.h"
#include "sim/units/cache/cache_pipe.h"
#include "sim/units/draw_unit.h"
#include "sim/units/vertex/vertex_unit.h"

namespace splatscope::sim {

// Reads indices and the vertices that are new among them, from video or AGP memory, and hands them to
// the vertex units one a cycle: the oldest to the unit that has room first, ties to the lower number.
class VertexFetch final : public DrawUnit {
 public:
  // Ports to one place of memory; both null: no draw of the trace has a buffer there.
  struct Ports {
    MemoryPort* indices = nullptr;
    MemoryPort* vertices = nullptr;
  };

  VertexFetch(std::string name, Completion& completion, const Machine::Fetch& spec);
  // `order` tells primitive assembly which unit has the next vertex.
  void connect(const Ports& video, const Ports& agp, std::vector<Channel<VertexNumber>*> units,
               Channel<std::uint8_t>& order);
  // The place of each buffer of the trace.
  void set_places(std::vector<MemoryPlace> places) { places_ = std::move(places); }

  Step advance(Cycle now) override;
  // Its triangles, and the end of the draw.
  std::uint64_t items(const DrawJob& job) const override {
    return job.all_triangles == 0 ? 0 : job.counts.triangles + (job.is_complete() ? 1 : 0);
  }
  std::uint64_t cuts_passed(const DrawJob& job) const override { return cuts_passed_by_tags(job); }
  std::vector<Statistic> statistics(Cycle) const override;
  std::string state() const override;

 private:
  void start(const DrawJob& job) override;
  bool deliver(Cycle now);
  bool end_draw(Cycle now);
  bool read_indices(Cycle now);
  bool wants_index_line() const;
  std::uint32_t next_index_line() const;  // its address
  bool walk(Cycle now);
  bool gather(Cycle now);
  struct Lines {
    std::uint32_t first, end;
  };
  Lines lines_of(std::uint32_t vertex) const;
  void pass(const Cut& cut);
  bool index_is_here(Cycle now);
  Step waiting(Cycle now);
  const Unit* no_unit_free(Cycle now) const;

  Machine::Fetch spec_;
  Ports places_ports_[2];
  std::vector<MemoryPlace> places_;
  std::vector<Channel<VertexNumber>*> units_;
  Channel<std::uint8_t>* order_ = nullptr;
  CachePipe cache_;
  MemoryPort* index_port_ = nullptr;

  // Indices: lines asked for, lines taken, and the lines that this draw spans.
  std::uint32_t first_index_line_ = 0, index_lines_ = 0, asked_ = 0, taken_ = 0;
  // The triangle that the walk is at, the new vertices of it still to gather, when its indices have been
  // taken.
  std::size_t triangle_ = 0;
  std::uint32_t new_vertices_ = 0;
  bool in_triangle_ = false;
  Cycle walk_from_ = 0;
  // The vertex being gathered, and its next line.
  std::size_t vertex_ = 0;
  std::uint32_t line_ = 0;
  bool in_vertex_ = false;
  std::uint32_t delivered_ = 0;  // vertices
  std::size_t ended_ = 0;        // units told that the draw ends
  const Unit* in_the_way_ = nullptr;
  std::uint64_t indices_read_ = 0, vertices_read_ = 0;
};

}  // namespace splatscope::sim
