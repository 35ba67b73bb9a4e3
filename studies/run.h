#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "kernels/reference/screen_space.h"
#include "model/machine/machine.h"
#include "model/render.h"
#include "sim/simulate.h"
#include "studies/heat_maps.h"
#include "studies/image_io.h"
#include "studies/reference_comparison.h"
#include "studies/study.h"
#include "traces/recorder.h"
#include "traces/volume_trace.h"

// The frames of a scene or a trace on one machine.
namespace splatscope::studies {

inline constexpr std::string_view kBothMachines[] = {machine::kGeForce4, machine::kRadeon8500};

enum class Fidelity { functional, throughput, sampled, cycle, referee };

// "functional", "throughput", "sampled", "cycle", "referee". Throws UserError (file "--fidelity") for another
// name.
Fidelity fidelity_by_name(std::string_view name);
std::string_view name(Fidelity fidelity);

using OnFrame = std::function<void(const Frame&)>;  // given each frame of a trace, in order

// The machine with another frame buffer. Beside one of more than 8 bits a channel, interpolated colours and
// the results of the pixel unit are in binary32: they would round each contribution to 8 bits.
Machine with_frame(Machine machine, FrameFormat format);

// What is run: a trace, and what the host knows about it where it was recorded from a scene.
struct Input {
  std::string name;
  Trace trace;
  std::optional<traces::RecordCounts> recorded;
  traces::SkipCounts skipped;
  traces::EstimateCounts estimated;
  traces::MeshCounts mesh;
  std::optional<traces::VolumeCounts> volume;
};

// A trace, or a scene of surfels or with a volume.
using Opened = std::variant<Trace, traces::Scene, traces::VolumeScene>;

// A trace file (".trace"), a scene file, or a ready scene by its name: read and checked.
Opened open_input(const std::string& scene_or_trace, const Progress& progress = {});

// Throws UserError for a trace, which knows nothing to draw a reference of, and for a volume by a map that is
// one of surfels.
void expect_reference(const Opened& opened, kernels::ScreenMap map, const std::string& name);

// What the frame of a scene should be: surfels by `map`, a volume in software with the same sheets.
kernels::ScreenSpacePicture reference_of(const Opened& opened, kernels::ScreenMap map);

// A scene is recorded for `machine`, whose number formats the captured weights depend on. `name` is a
// trace's.
Input make_input(Opened opened, const std::string& name, const Machine& machine,
                 const Progress& progress = {});

// What the frame should be, and how far it is from that.
struct AgainstReference {
  kernels::ScreenSpacePicture picture;
  Comparison comparison;
};

struct FrameRun {
  Rendered rendered;
  std::optional<sim::Result> timing;          // absent: functional
  double host_seconds = 0;                    // function and timing
  std::vector<HeatMap> heat_maps;             // where they are asked for
  std::optional<AgainstReference> reference;  // where it is asked for
  std::optional<std::uint64_t> seed = {};     // of the samples of `sampled`
};

struct TimingOptions {
  std::uint64_t seed = 1;                          // of the samples
  std::span<sim::Observer* const> observers = {};  // watch a run that is simulated (cycle, referee)
  HeatMaps* heat_maps = nullptr;                   // given the work of each draw, or of its parts
};

// The time of a frame whose function gave `work`, by any fidelity but functional.
sim::Result time_frame(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                       Fidelity fidelity, const TimingOptions& options = {}, const Progress& progress = {});

// Starts oneTBB's threads now, from any thread, which else the first frame waits for.
void start_threads();

// Instruction slots of a program, which is assembled for them.
int slots_of(const ShaderText& program);

// Frames a second, and the unit that is busy for the largest share of the frame.
struct Rate {
  double fps = 0;
  std::string bottleneck;
  double share = 0;  // of the frame, 0 to 1
};
Rate rate_of(const sim::Result& timing);
// "123 cycles", "3 frames together: 123 +- 4 cycles".
std::string text_of_cycles(std::size_t frames, std::uint64_t cycles, double plus_minus);
// For tables: "24.99 (vertex0)", frames a second and the unit; "vertex0 (99 % busy)".
std::string text_of_rate(const Rate& rate);
std::string text_of_bottleneck(const Rate& rate);

// Where events are simulated (sampled, cycle, referee), the function of what comes next runs in a thread
// beside the time of this, and calls `on_frame`. The records of work are dropped once they are simulated.
FrameRun run_frame(const Trace& trace, const Machine& machine, Fidelity fidelity,
                   const Progress& progress = {}, const OnFrame& on_frame = {},
                   const TimingOptions& timing = {});

// The last frame alone (functional): of a trace, or of a scene recorded with given weights or with its own.
Frame draw_frame(const Trace& trace, const Machine& machine);
Frame draw_frame(const traces::Scene& scene, const traces::CapturedWeights& weights, const Machine& machine);
Frame draw_frame(const traces::Scene& scene, const Machine& machine, const Progress& progress = {});

// Compares the frame that `trace` left on `machine` with the reference, and draws it once more by with_frame
// in floats where pixels that rounded to black have to be told from holes.
Comparison compare(const Frame& frame, const Trace& trace, const Machine& machine,
                   const kernels::ScreenSpacePicture& reference);

// The picture with its alpha set to 1, and the depths.
Image picture_of(const Frame& frame);
GrayImage depth_of(const Frame& frame);

}  // namespace splatscope::studies
