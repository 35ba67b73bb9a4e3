#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "model/command/commands.h"
#include "model/number/formats.h"
#include "model/output/frame.h"
#include "model/work/work.h"

// The whole machine as a function: a trace in, its frames and its work out. No time.
namespace splatscope {

struct Machine;

// What is noted of the work, for the timing: nothing, all, or as much as an estimate looks at (DrawWork).
enum class Record : std::uint8_t { nothing, samples, everything };

struct RenderOptions {
  NumberFormats formats;
  int vertex_cache_entries = 18;  // post-transform FIFO; a vertex still in it is not shaded again
  Record record = Record::everything;
  bool operator==(const RenderOptions&) const = default;
};

// As `machine` draws.
RenderOptions render_options(const Machine& machine, Record record = Record::everything);

// What became of the triangles and fragments of a trace.
struct RenderCounters {
  std::uint64_t vertices = 0;  // shaded
  std::uint64_t triangles = 0;
  std::uint64_t triangles_without_coverage = 0;
  std::uint64_t triangles_outside = 0;      // of the frustum
  std::uint64_t triangles_behind = 0;       // before the near plane or behind the eye
  std::uint64_t triangles_not_finite = 0;   // NaN or INF positions: dropped
  std::uint64_t triangles_back_facing = 0;  // dropped by the cull mode
  std::uint64_t triangles_clipped = 0;
  std::uint64_t quads = 0;
  std::uint64_t fragments = 0;         // covered pixels
  std::uint64_t fragments_passed = 0;  // of these, those that passed the depth test
};

struct Rendered {
  Frame frame;                 // the last one
  std::vector<DrawWork> work;  // one for each Draw of the trace, in order; empty where nothing is recorded
  RenderCounters counters;
};

// Draws every command of `trace`. The trace must hold together (traces/ checks one that comes from a file):
// indices in range, index counts multiples of 3. Throws UserError where a program does not assemble.
// `progress` is told the fraction done as a command begins, from 0 to below 1. `on_frame` is given every
// frame of the trace (`frame_ends`) when it is done, in order. `on_work` takes the work of each draw when it
// is done, in order; it is then not kept. The next draws are begun meanwhile: `progress` and `on_work` are
// called from any thread and beside one another.
Rendered render(const Trace& trace, const RenderOptions& options,
                const std::function<void(double)>& progress = {},
                const std::function<void(const Frame&)>& on_frame = {},
                const std::function<void(DrawWork)>& on_work = {});

// The same with the work in parts, of the draws in order: what some triangles did, one behind the other, as
// soon as it is done. So it takes little memory, whatever is drawn. A draw of no triangles has one part, of
// nothing. Numbers of triangles are those of the draw. `on_part` may leave another record in place of the one
// that it is given, whose memory is then used again.
Rendered render_in_parts(const Trace& trace, const RenderOptions& options,
                         const std::function<void(double)>& progress,
                         const std::function<void(const Frame&)>& on_frame,
                         const std::function<void(DrawWork& part)>& on_part);

// The frame that `commands` leave on the buffers, textures and programs of `trace`: many views share them.
// Nothing is recorded.
Frame render_view(const Trace& trace, std::span<const Command> commands, RenderOptions options);

// Draws a frame piece by piece, and shows what there is in between.
class Replay {
 public:
  // Draws on the resources of `trace`, which must outlive it. The frame and the surfaces are clear.
  Replay(const Trace& trace, const NumberFormats& formats);
  ~Replay();

  // The commands that come next.
  void run(std::vector<Command> commands);
  // The frame (0) or an off-screen surface, as the target of a draw.
  const Frame& target(std::uint32_t number) const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace splatscope
