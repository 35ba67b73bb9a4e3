#include "studies/run.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <future>

#include "model/command/load_program.h"
#include "model/error.h"
#include "model/isa/program.h"
#include "sim/fidelity/sampled.h"
#include "sim/fidelity/throughput.h"
#include "studies/image_io.h"
#include "studies/measure.h"
#include "studies/reference_comparison.h"
#include "studies/work_queue.h"
#include "traces/scene_text.h"
#include "traces/trace_file.h"

namespace splatscope::studies {
namespace {

constexpr std::pair<std::string_view, Fidelity> kFidelities[] = {{"functional", Fidelity::functional},
                                                                 {"throughput", Fidelity::throughput},
                                                                 {"sampled", Fidelity::sampled},
                                                                 {"cycle", Fidelity::cycle},
                                                                 {"referee", Fidelity::referee}};

// Of the two that simulate every event.
sim::Scheduler scheduler_of(Fidelity fidelity) {
  return fidelity == Fidelity::referee ? sim::Scheduler::referee : sim::Scheduler::skip_ahead;
}

}  // namespace

Fidelity fidelity_by_name(std::string_view name) {
  for (const auto& [known, fidelity] : kFidelities) {
    if (known == name) return fidelity;
  }
  throw UserError(
      "--fidelity", 0,
      fmt::format("unknown fidelity \"{}\", expected functional, throughput, sampled, cycle or referee",
                  name));
}

std::string_view name(Fidelity fidelity) {
  for (const auto& [known, value] : kFidelities) {
    if (value == fidelity) return known;
  }
  throw ModelError("a fidelity without a name");
}

Machine with_frame(Machine machine, FrameFormat format) {
  machine.numbers.frame = format;
  if (format != FrameFormat::unorm8) {
    machine.numbers.color = ColorFormat::float32;
    machine.numbers.combiner = CombinerFormat::float32;
  }
  return machine;
}

Opened open_input(const std::string& scene_or_trace, const Progress& progress) {
  if (std::filesystem::path(scene_or_trace).extension() == ".trace")
    return traces::read_trace(scene_or_trace);
  const traces::SceneText text = traces::read_scene_text(scene_or_trace);
  if (traces::has_volume(text)) return traces::parse_volume_scene(text.text, text.file);
  return traces::load_scene(text, progress);
}

void expect_reference(const Opened& opened, kernels::ScreenMap map, const std::string& name) {
  if (std::holds_alternative<Trace>(opened))
    throw UserError(name, 0, "a trace has no surfels to draw a reference of, expected a scene");
  if (std::holds_alternative<traces::VolumeScene>(opened) && map == kernels::ScreenMap::perspective)
    throw UserError("--reference", 0, "perspective is a map of surfels, expected affine for a volume");
}

kernels::ScreenSpacePicture reference_of(const Opened& opened, kernels::ScreenMap map) {
  if (const auto* volume = std::get_if<traces::VolumeScene>(&opened)) return volume_reference(*volume);
  return screen_space_reference(std::get<traces::Scene>(opened), map);
}

Input make_input(Opened opened, const std::string& name, const Machine& machine, const Progress& progress) {
  if (auto* trace = std::get_if<Trace>(&opened)) return {name, std::move(*trace), {}, {}, {}, {}, {}};
  if (const auto* scene = std::get_if<traces::VolumeScene>(&opened)) {
    traces::VolumeTrace recorded = traces::record(*scene);
    return {scene->name, std::move(recorded.trace), {}, {}, {}, {}, recorded};
  }
  const traces::Scene& scene = std::get<traces::Scene>(opened);
  traces::Recording recording = traces::record(scene, machine.numbers, progress);
  return {
      scene.name, std::move(recording.trace), recording.counts, scene.skipped, scene.estimated, scene.mesh,
      {}};
}

sim::Result time_frame(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                       Fidelity fidelity, const TimingOptions& options, const Progress& progress) {
  switch (fidelity) {
    case Fidelity::throughput:
      return sim::estimate_throughput(trace, work, machine);
    case Fidelity::sampled:
      return sim::estimate_sampled(trace, work, machine, options.seed);
    case Fidelity::referee:
    case Fidelity::cycle:
      return sim::simulate(trace, work, machine, scheduler_of(fidelity), progress, options.observers);
    case Fidelity::functional:
      break;
  }
  throw ModelError("functional has no time");
}

int slots_of(const ShaderText& program) {
  return isa::slot_count(load_program(program));
}

Rate rate_of(const sim::Result& timing) {
  const sim::Result::Bottleneck bottleneck = timing.bottleneck();
  return {timing.frames_per_second(), bottleneck.unit, timing.share(bottleneck.busy)};
}

std::string text_of_cycles(std::size_t frames, std::uint64_t cycles, double plus_minus) {
  return fmt::format("{}{}{} cycles", frames == 1 ? "" : fmt::format("{} frames together: ", frames), cycles,
                     plus_minus > 0 ? fmt::format(" +- {:.0f}", plus_minus) : "");
}

std::string text_of_rate(const Rate& rate) {
  return fmt::format("{:.2f} ({})", rate.fps, rate.bottleneck);
}

std::string text_of_bottleneck(const Rate& rate) {
  return fmt::format("{} ({:.0f} % busy)", rate.bottleneck, 100 * rate.share);
}

namespace {

// The throughput of each draw after its function, while its work is at hand.
FrameRun run_throughput(const Trace& trace, const Machine& machine, const RenderOptions& options,
                        const Progress& progress, const OnFrame& on_frame) {
  sim::ThroughputEstimate estimate(trace, machine, {});
  Rendered rendered =
      render(trace, options, progress, on_frame, [&](const DrawWork& work) { estimate.add(work); });
  return {std::move(rendered), estimate.result(), 0, {}, {}};
}

// The time after the function, if any.
FrameRun run_after(const Trace& trace, const Machine& machine, Fidelity fidelity,
                   const RenderOptions& options, const Progress& progress, const OnFrame& on_frame,
                   const TimingOptions& timing) {
  FrameRun run{render(trace, options, progress, on_frame), {}, 0, {}, {}};
  if (timing.heat_maps) {
    for (const DrawWork& work : run.rendered.work) timing.heat_maps->add(work);
  }
  if (fidelity == Fidelity::functional) return run;
  run.timing = time_frame(trace, run.rendered.work, machine, fidelity, timing);
  run.rendered.work = {};
  return run;
}

// How much of a frame's work waits for its time. Samples take long and what lies between them passes quickly:
// the more waits, the less the two wait for one another; of a small frame little, as its memory would be that
// of what waits.
std::size_t parts_ahead(const Trace& trace, Fidelity fidelity) {
  constexpr std::size_t kLeast = 4, kMost = 256, kTriangles = 10000;
  if (fidelity != Fidelity::sampled) return kLeast;
  std::size_t triangles = 0;
  for (const Command& command : trace.commands)
    if (const Draw* draw = std::get_if<Draw>(&command)) triangles += draw->index_count / 3;
  return std::clamp(triangles / kTriangles, kLeast, kMost);
}

// The function of what comes next beside the time of this, which `time` takes from the source of the parts.
// One thread is fast enough for the function, and holds one batch.
template <typename Time>
Rendered render_beside(const Trace& trace, Fidelity fidelity, const RenderOptions& options,
                       const OnFrame& on_frame, HeatMaps* heat_maps, Time time) {
  WorkQueue queue(parts_ahead(trace, fidelity));
  std::future<Rendered> function = std::async(std::launch::async, [&] {
    try {
      const auto put = [&](DrawWork& work) {
        if (heat_maps) heat_maps->add(work);
        queue.put(work);
      };
      return tbb::task_arena(1).execute([&] { return render_in_parts(trace, options, {}, on_frame, put); });
    } catch (...) {
      queue.fail(std::current_exception());
      throw;
    }
  });
  const struct Stop {  // before the future waits for its thread
    WorkQueue& queue;
    ~Stop() { queue.stop(); }
  } stop{queue};
  time([&]() -> const DrawWork& { return queue.next(); });
  return function.get();
}

FrameRun run_simulated(const Trace& trace, const Machine& machine, Fidelity fidelity,
                       const RenderOptions& options, const Progress& progress, const OnFrame& on_frame,
                       const TimingOptions& timing) {
  sim::Result result;
  const auto time = [&](const sim::PartSource& next) {
    result = sim::simulate_beside(trace, next, machine, scheduler_of(fidelity), progress, timing.observers);
  };
  Rendered rendered = render_beside(trace, fidelity, options, on_frame, timing.heat_maps, time);
  return {std::move(rendered), std::move(result), 0, {}, {}};
}

// Once more where its samples were too few, for the time alone.
FrameRun run_sampled(const Trace& trace, const Machine& machine, const RenderOptions& options,
                     const Progress& progress, const OnFrame& on_frame, const TimingOptions& timing) {
  sim::SampledRun run;
  const auto time = [&](const sim::PartSource& next) {
    run = sim::estimate_sampled_beside(trace, next, machine, {timing.seed, run.density}, progress);
  };
  Rendered rendered = render_beside(trace, Fidelity::sampled, options, on_frame, timing.heat_maps, time);
  if (!run.density.empty()) render_beside(trace, Fidelity::sampled, options, {}, nullptr, time);
  return {std::move(rendered), std::move(run.result), 0, {}, {}};
}

}  // namespace

void start_threads() {
  tbb::parallel_for(0, 2, [](int) {});
}

FrameRun run_frame(const Trace& trace, const Machine& machine, Fidelity fidelity, const Progress& progress,
                   const OnFrame& on_frame, const TimingOptions& timing) {
  const auto start = HostClock::now();
  RenderOptions options = render_options(machine);
  if (fidelity == Fidelity::functional) options.record = Record::nothing;
  if (fidelity == Fidelity::throughput) options.record = Record::samples;
  if (timing.heat_maps) options.record = Record::everything;
  const auto run_it = [&] {
    if (options.record == Record::samples) return run_throughput(trace, machine, options, progress, on_frame);
    if (fidelity == Fidelity::functional || fidelity == Fidelity::throughput)
      return run_after(trace, machine, fidelity, options, progress, on_frame, timing);
    if (fidelity == Fidelity::sampled)
      return run_sampled(trace, machine, options, progress, on_frame, timing);
    return run_simulated(trace, machine, fidelity, options, progress, on_frame, timing);
  };
  FrameRun run = run_it();
  run.host_seconds = seconds_since(start);
  if (timing.heat_maps) run.heat_maps = timing.heat_maps->maps();
  if (fidelity == Fidelity::sampled) run.seed = timing.seed;
  return run;
}

Frame draw_frame(const Trace& trace, const Machine& machine) {
  return run_frame(trace, machine, Fidelity::functional).rendered.frame;
}

Frame draw_frame(const traces::Scene& scene, const traces::CapturedWeights& weights, const Machine& machine) {
  return draw_frame(traces::record(scene, weights).trace, machine);
}

Frame draw_frame(const traces::Scene& scene, const Machine& machine, const Progress& progress) {
  return draw_frame(traces::record(scene, machine.numbers, progress).trace, machine);
}

Comparison compare(const Frame& frame, const Trace& trace, const Machine& machine,
                   const kernels::ScreenSpacePicture& reference) {
  return compare(frame, reference,
                 [&] { return draw_frame(trace, with_frame(machine, FrameFormat::float32)); });
}

Image picture_of(const Frame& frame) {
  Image image(static_cast<int>(frame.width), static_cast<int>(frame.height));
  for (std::size_t pixel = 0; pixel < image.pixels.size(); ++pixel) {
    image.pixels[pixel] = frame.color(pixel);
    image.pixels[pixel][3] = 1;
  }
  return image;
}

GrayImage depth_of(const Frame& frame) {
  GrayImage image{static_cast<int>(frame.width), static_cast<int>(frame.height), {}};
  image.pixels.resize(frame.depth.size());
  for (std::size_t pixel = 0; pixel < image.pixels.size(); ++pixel) {
    image.pixels[pixel] = static_cast<float>(frame.depth_value(pixel));
  }
  return image;
}

}  // namespace splatscope::studies
