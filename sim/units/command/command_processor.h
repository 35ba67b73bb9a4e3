#pragma once

#include <functional>
#include <vector>

#include "sim/kernel/channel.h"
#include "sim/units/blend/blend_unit.h"
#include "sim/units/depth/depth_unit.h"
#include "sim/units/draw_unit.h"

namespace splatscope::sim {

// hand_over: flush, and forget the frame's colours, which the host is going to rewrite.
enum class OrderKind : std::uint8_t { draw, clear, flush, hand_over };

// What the host tells the command processor: a command of the trace, or to write the caches back.
struct Order {
  OrderKind kind = OrderKind::draw;
  std::uint32_t job = 0;  // of a draw, which
};

// Takes orders from the host one at a time and reports each one when the pipeline has drained. Called after
// all other units of its domain, so that what it begins is seen by them from the next cycle on.
class CommandProcessor final : public Unit {
 public:
  // A surface that a clear writes: not a depth buffer that is only marked, or that no draw uses.
  struct Surface {
    std::uint32_t address = 0;
    std::uint32_t bytes = 0;
  };

  CommandProcessor(std::string name, Completion& completion);
  void connect(Channel<Order>& from_host, Channel<std::uint32_t>& to_host, MemoryPort& port);
  void set_draws(const std::vector<DrawJob>& jobs, std::vector<DrawUnit*> units);
  // Called with its number before a draw begins.
  void on_draw(std::function<void(std::uint32_t)> prepare) { prepare_ = std::move(prepare); }
  // Null where the machine of this trace has none.
  void set_frame(DepthUnit* depth, bool fast_depth_clear, BlendUnit* blend, std::vector<Surface> cleared);

  Step advance(Cycle now) override;
  std::vector<Statistic> statistics(Cycle) const override;
  std::string state() const override;

 private:
  enum class Phase : std::uint8_t { waiting, working, filling, reporting };

  void begin(Cycle now, const Order& order);
  void begin_draw(Cycle now, const DrawJob& job);
  void begin_flush(Cycle now);
  void begin_clear();
  bool fill(Cycle now);

  Completion& completion_;
  Channel<Order>* from_host_ = nullptr;
  Channel<std::uint32_t>* to_host_ = nullptr;
  MemoryPort* port_ = nullptr;
  const std::vector<DrawJob>* jobs_ = nullptr;
  std::vector<DrawUnit*> units_;
  std::function<void(std::uint32_t)> prepare_;
  DepthUnit* depth_ = nullptr;
  bool fast_depth_clear_ = false;
  BlendUnit* blend_ = nullptr;
  std::vector<Surface> cleared_;

  Phase phase_ = Phase::waiting;
  const DrawJob* after_flush_ = nullptr;  // begins when the caches are written back
  bool hands_over_ = false;               // then
  std::size_t surface_ = 0;               // of the fill
  std::uint32_t filled_ = 0;              // bytes of it
  std::uint32_t orders_ = 0;
  std::uint64_t bytes_filled_ = 0;
};

}  // namespace splatscope::sim
