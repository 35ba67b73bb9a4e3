#pragma once

#include "sim/kernel/channel.h"
#include "sim/units/cache/cache_pipe.h"
#include "sim/units/draw_unit.h"
#include "sim/units/frame_lines.h"

namespace splatscope::sim {

// A unit that looks the lines of each quad up in a cache as it enters, and lets quads leave in order.
class CachedUnit : public DrawUnit {
 public:
  std::string state() const override;
  std::uint64_t cuts_passed(const DrawJob& job) const final { return cuts_passed_by_tags(job); }

 protected:
  CachedUnit(std::string name, Completion& completion, const CachePipe::Spec& cache, int quads_per_clock)
      : DrawUnit(std::move(name), completion), quads_per_clock_(quads_per_clock), cache_(cache) {}

  // Nothing could be moved in this cycle: why, and until when. `out`: where quads go; nullptr: they end here.
  Step waiting(Cycle now, const Items* out);

  // Before quad `number` is looked up: what the draw left out before it passes through the tags.
  void pass_cuts(std::uint32_t number) {
    DrawUnit::pass_cuts(&Cut::quad, number, [this](const Cut& cut) { pass(cut); });
  }
  virtual void pass(const Cut& cut) = 0;

  int quads_per_clock_;
  Items* in_ = nullptr;
  CachePipe cache_;
  const Unit* in_the_way_ = nullptr;  // of the quad that would enter
};

// One whose cache holds lines of a buffer of the frame, and is flushed to memory at its end.
class FrameUnit : public CachedUnit {
 public:
  Step advance(Cycle now) final;

  // From the command processor: dirty lines go to memory.
  void begin_flush() { flushing_ = true; }

 protected:
  FrameUnit(std::string name, Completion& completion, const CachePipe::Spec& cache, const FrameLines& lines,
            int quads_per_clock)
      : CachedUnit(std::move(name), completion, cache, quads_per_clock), lines_(lines) {}

  // Moves one quad. False: none could be.
  virtual bool leave(Cycle now) = 0;
  virtual bool enter(Cycle now) = 0;

  FrameLines lines_;
  Items* out_ = nullptr;  // nullptr: quads end here

 private:
  Step flush(Cycle now);

  bool flushing_ = false;
};

}  // namespace splatscope::sim
