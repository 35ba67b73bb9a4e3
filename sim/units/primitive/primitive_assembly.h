#pragma once

#include <functional>
#include <vector>

#include "model/machine/machine.h"
#include "sim/kernel/channel.h"
#include "sim/units/draw_unit.h"
#include "sim/units/vertex/vertex_unit.h"

namespace splatscope::sim {

// Takes the shaded vertices in their order, makes triangles of them, drops those that need no setup (outside
// the frustum, before the near plane, not finite), and clips.
class PrimitiveAssembly final : public DrawUnit {
 public:
  PrimitiveAssembly(std::string name, Completion& completion, const Machine::Primitive& spec);
  // `order`: which vertex unit has the next vertex. `out`: the numbers of the triangles to set up.
  void connect(Channel<std::uint8_t>& order, std::vector<Channel<VertexNumber>*> units, Items& out);

  Step advance(Cycle now) override;
  std::uint64_t items(const DrawJob& job) const override { return job.counts.triangles; }
  std::vector<Statistic> statistics(Cycle) const override;
  std::string state() const override;

  // Called with the triangles done so far, every few thousand.
  void on_progress(std::function<void(std::uint64_t)> report) { report_ = std::move(report); }
  // Called as a marked triangle is assembled.
  void on_mark(std::function<void(Cycle)> tell) { tell_ = std::move(tell); }

 private:
  void start(const DrawJob& job) override;
  bool take_vertex(Cycle now);
  bool assemble(Cycle now);

  Machine::Primitive spec_;
  Channel<std::uint8_t>* order_ = nullptr;
  std::vector<Channel<VertexNumber>*> units_;
  Items* out_ = nullptr;
  std::size_t triangle_ = 0;
  std::uint32_t vertices_ = 0;  // taken and not used by a triangle yet
  Cycle free_from_ = 0;
  std::function<void(std::uint64_t)> report_;
  std::function<void(Cycle)> tell_;
  std::size_t next_mark_ = 0;  // of the draw
  std::uint64_t assembled_ = 0, rejected_ = 0, clipped_ = 0;
};

}  // namespace splatscope::sim
