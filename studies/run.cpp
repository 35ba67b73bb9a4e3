#include "studies/run.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <exception>
#include <future>

#include "model/error.h"
#include "model/isa/program.h"
#include "sim/fidelity/sampled.h"
#include "sim/fidelity/throughput.h"
#include "studies/measure.h"
#include "studies/reference_comparison.h"
#include "studies/report/run_report.h"
#include "studies/roofline.h"
#include "studies/run_files.h"
#include "studies/work_queue.h"
#include "traces/output_files.h"
#include "traces/scene_text.h"
#include "traces/trace_file.h"

namespace splatscope::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::pair<std::string_view, Fidelity> kFidelities[] = {{"functional", Fidelity::functional},
                                                                 {"throughput", Fidelity::throughput},
                                                                 {"sampled", Fidelity::sampled},
                                                                 {"cycle", Fidelity::cycle},
                                                                 {"referee", Fidelity::referee}};

Json frames_json(const sim::Result& timing) {
  Json out = Json::array();
  for (const sim::Cycle cycles : timing.frame_cycles) {
    const double seconds = timing.seconds_of(cycles);
    Json frame = {{"cycles", cycles}, {"milliseconds", 1000 * seconds}, {"frames_per_second", 1 / seconds}};
    // Both of the whole run; an estimate has no events.
    if (timing.cycles_plus_minus > 0) frame["cycles_plus_minus"] = timing.cycles_plus_minus;
    if (timing.event_hash != 0) frame["event_hash"] = fmt::format("{:016x}", timing.event_hash);
    out.push_back(std::move(frame));
  }
  return out;
}

// With the names of the pictures.
Json frames_json(const FrameRun& run, std::size_t frames) {
  Json out = run.timing ? frames_json(*run.timing) : Json(std::vector<Json>(frames, Json::object()));
  for (std::size_t i = 0; i < frames; ++i) out[i]["picture"] = picture_name(i, frames);
  return out;
}

Json units_json(const sim::Result& timing) {
  Json units = Json::array();
  for (const sim::UnitBooks& books : timing.units) {
    Json blocked_by = Json::object();
    for (const auto& [who, cycles] : books.blocked_by) blocked_by[who] = cycles;
    units.push_back({{"name", books.name},
                     {"busy", books.busy},
                     {"starved", books.starved},
                     {"blocked", books.blocked},
                     {"idle", books.idle},
                     {"blocked_by", blocked_by}});
  }
  return units;
}

Json left_out_json(const sim::Result& timing) {
  Json out = Json::array();
  for (const sim::UnitLeftOut& unit : timing.units_left_out)
    out.push_back({{"name", unit.name}, {"why", unit.why}});
  return out;
}

struct Total {
  std::string_view name, unit, what;
  std::uint64_t RenderCounters::*value;
};
constexpr Total kTotals[] = {
    {"vertices", "vertices", "shaded", &RenderCounters::vertices},
    {"triangles", "triangles", "as indexed", &RenderCounters::triangles},
    {"triangles_without_coverage", "triangles", "that cover no pixel centre",
     &RenderCounters::triangles_without_coverage},
    {"triangles_outside_frustum", "triangles", "wholly outside one clip plane",
     &RenderCounters::triangles_outside},
    {"triangles_behind_near", "triangles", "before the near plane or behind the eye",
     &RenderCounters::triangles_behind},
    {"triangles_not_finite", "triangles", "with a NaN or an infinity in a position: dropped",
     &RenderCounters::triangles_not_finite},
    {"triangles_back_facing", "triangles", "dropped by the cull mode",
     &RenderCounters::triangles_back_facing},
    {"triangles_clipped", "triangles", "cut by a clip plane", &RenderCounters::triangles_clipped},
    {"quads", "quads", "2x2 pixels with coverage", &RenderCounters::quads},
    {"fragments", "pixels", "covered, each triangle by itself", &RenderCounters::fragments},
    {"fragments_passed", "pixels", "of these, those that passed the depth test",
     &RenderCounters::fragments_passed},
};

Json counters_json(const RenderCounters& counters) {
  Json out;
  for (const Total& total : kTotals) out[std::string(total.name)] = counters.*total.value;
  return out;
}

// The counters as the statistics of the units stand there, with unit and meaning.
Json totals_json(const RenderCounters& counters) {
  Json out = Json::array();
  for (const Total& total : kTotals) {
    out.push_back(
        {{"name", total.name}, {"value", counters.*total.value}, {"unit", total.unit}, {"what", total.what}});
  }
  return out;
}

Json statistics_json(const sim::Result& timing) {
  Json out = Json::array();
  for (const sim::UnitStatistic& s : timing.statistics) {
    out.push_back(
        {{"of", s.unit_name}, {"name", s.name}, {"value", s.value}, {"unit", s.unit}, {"what", s.what}});
  }
  return out;
}

// A figure that no file can hold, an infinite PSNR, is null.
Json reference_json(const Comparison& c) {
  return {{"psnr_decibels", c.psnr},
          {"surface_pixels", c.surface_pixels},
          {"psnr_off_edges_decibels", c.psnr_off_edges},
          {"pixels_off_edges", c.pixels_off_edges},
          {"worst", c.worst},
          {"pixels_over_8", c.over_8},
          {"inside_pixels", c.inside_pixels},
          {"holes", c.holes},
          {"rounded_to_black", c.rounded_to_black}};
}

Json mesh_json(const traces::MeshCounts& mesh) {
  return {{"triangles", mesh.triangles},
          {"triangles_not_finite", mesh.triangles_not_finite},
          {"triangles_out_of_range", mesh.triangles_out_of_range},
          {"triangles_degenerate", mesh.triangles_degenerate},
          {"normals_computed", mesh.normals_computed},
          {"textures_unreadable", mesh.textures_unreadable}};
}

Json blocks_json(const traces::BlockCounts& blocks) {
  return {{"drawn", blocks.blocks},
          {"surfels_by_level", blocks.surfels_by_level},
          {"surfels_outside_frustum", blocks.outside_frustum},
          {"surfels_facing_away", blocks.facing_away}};
}

Json surfels_json(const traces::RecordCounts& recorded, const traces::SkipCounts& skipped,
                  const traces::EstimateCounts& estimated) {
  return {{"drawn", recorded.surfels},
          {"normals_estimated", estimated.normals},
          {"radii_estimated", estimated.radii},
          {"blocks", blocks_json(recorded.blocks)},
          {"weights_captured", recorded.weights_captured},
          {"weights_at_edges", recorded.weights_at_edges},
          {"weights_by_default", recorded.weights_by_default},
          {"weights_outside_box", recorded.weights_outside_box},
          {"skipped",
           {{"not_finite", skipped.not_finite},
            {"zero_radius", skipped.zero_radius},
            {"duplicate", skipped.duplicate},
            {"zero_normal", skipped.zero_normal}}}};
}

Json volume_json(const traces::VolumeCounts& counts) {
  return {{"splats", counts.splats},
          {"flat_splats", counts.flat},
          {"left_out", counts.left_out},
          {"sheets", counts.sheets},
          {"vertex_bytes", counts.vertex_bytes}};
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

Opened open_input(const std::string& scene_or_trace, const Progress& progress) {
  if (std::filesystem::path(scene_or_trace).extension() == ".trace")
    return traces::read_trace(scene_or_trace);
  const traces::SceneText text = traces::read_scene_text(scene_or_trace);
  if (traces::has_volume(text)) return traces::parse_volume_scene(text.text, text.file);
  return traces::load_scene(text, progress);
}

void expect_scene(const Opened& opened, const std::string& name) {
  if (std::holds_alternative<Trace>(opened))
    throw UserError(name, 0, "a trace has no surfels to draw a reference of, expected a scene");
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
      return sim::simulate(trace, work, machine, sim::Scheduler::referee, progress, options.observers);
    default:
      return sim::simulate(trace, work, machine, sim::Scheduler::skip_ahead, progress, options.observers);
  }
}

namespace {

// The throughput of each draw after its function, while its work is at hand.
FrameRun run_throughput(const Trace& trace, const Machine& machine, const RenderOptions& options,
                        const Progress& progress, const OnFrame& on_frame) {
  double seconds = 0;
  const auto timed = [&](auto run) {
    const auto start = HostClock::now();
    run();
    seconds += seconds_since(start);
  };
  sim::ThroughputEstimate estimate(trace, machine, {});
  FrameRun run{render(trace, options, progress, on_frame,
                      [&](const DrawWork& work) { timed([&] { estimate.add(work); }); }),
               {},
               0,
               0,
               {},
               {}};
  timed([&] { run.timing = estimate.result(); });
  run.timing_seconds = seconds;
  return run;
}

// The time after the function.
FrameRun run_after(const Trace& trace, const Machine& machine, Fidelity fidelity,
                   const RenderOptions& options, const Progress& progress, const OnFrame& on_frame,
                   const TimingOptions& timing) {
  FrameRun run{render(trace, options, progress, on_frame), {}, 0, 0, {}, {}};
  if (timing.heat_maps) {
    for (const DrawWork& work : run.rendered.work) timing.heat_maps->add(work);
  }
  if (fidelity == Fidelity::functional) return run;
  const auto start = HostClock::now();
  run.timing = time_frame(trace, run.rendered.work, machine, fidelity, timing);
  run.timing_seconds = seconds_since(start);
  run.rendered.work = {};
  return run;
}

// The function of the next draws beside the time of this one.
FrameRun run_beside(const Trace& trace, const Machine& machine, Fidelity fidelity,
                    const RenderOptions& options, const Progress& progress, const OnFrame& on_frame,
                    const TimingOptions& timing) {
  const auto start = HostClock::now();
  WorkQueue queue;
  std::future<Rendered> function = std::async(std::launch::async, [&] {
    try {
      return render(trace, options, {}, on_frame, [&](DrawWork work) {
        if (timing.heat_maps) timing.heat_maps->add(work);
        queue.put(std::move(work));
      });
    } catch (...) {
      queue.fail(std::current_exception());
      throw;
    }
  });
  const struct Stop {  // before the future waits for its thread
    WorkQueue& queue;
    ~Stop() { queue.stop(); }
  } stop{queue};
  const auto scheduler = fidelity == Fidelity::referee ? sim::Scheduler::referee : sim::Scheduler::skip_ahead;
  sim::Result result = sim::simulate_beside(
      trace, [&](std::size_t) -> const DrawWork& { return queue.next(); }, machine, scheduler, progress,
      timing.observers);
  const double seconds = seconds_since(start);
  return {function.get(), std::move(result), 0, seconds, {}, {}};
}

}  // namespace

FrameRun run_frame(const Trace& trace, const Machine& machine, Fidelity fidelity, const Progress& progress,
                   const OnFrame& on_frame, const TimingOptions& timing) {
  const auto start = HostClock::now();
  RenderOptions options;
  options.formats = machine.numbers;
  options.vertex_cache_entries = machine.vertex.cache_entries;
  if (fidelity == Fidelity::functional) options.record = Record::nothing;
  if (fidelity == Fidelity::throughput) options.record = Record::samples;
  if (timing.heat_maps) options.record = Record::everything;
  const auto run_it = [&] {
    if (options.record == Record::samples) return run_throughput(trace, machine, options, progress, on_frame);
    if (fidelity == Fidelity::cycle || fidelity == Fidelity::referee)
      return run_beside(trace, machine, fidelity, options, progress, on_frame, timing);
    return run_after(trace, machine, fidelity, options, progress, on_frame, timing);
  };
  FrameRun run = run_it();
  run.host_seconds = seconds_since(start);
  if (timing.heat_maps) run.heat_maps = timing.heat_maps->maps();
  return run;
}

Comparison compare(const Frame& frame, const Trace& trace, const Machine& machine,
                   const kernels::ScreenSpacePicture& reference) {
  Machine exact = machine;
  exact.numbers.frame = FrameFormat::float32;
  return compare(frame, reference,
                 [&] { return run_frame(trace, exact, Fidelity::functional).rendered.frame; });
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

nlohmann::ordered_json timing_json(const sim::Result& timing) {
  return {{"frames", frames_json(timing)},
          {"units", units_json(timing)},
          {"units_left_out", left_out_json(timing)}};
}

nlohmann::ordered_json results_of(const Input& input, const Machine& machine, Fidelity fidelity,
                                  const FrameRun& run) {
  Json results;
  results["input"] = input.name;
  results["machine"] = machine.name;
  results["fidelity"] = name(fidelity);
  results["frames"] = frames_json(run, frame_ends(input.trace).size());
  results["programs"] = Json::array();
  for (const ShaderText& program : input.trace.programs) {
    results["programs"].push_back(
        {{"name", program.name}, {"slots", isa::slot_count(isa::load(program.text, program.name))}});
  }
  results["units"] = run.timing ? units_json(*run.timing) : Json::array();
  results["units_left_out"] = run.timing ? left_out_json(*run.timing) : Json::array();
  results["counters"] = counters_json(run.rendered.counters);
  results["totals"] = totals_json(run.rendered.counters);
  if (run.timing) {
    results["statistics"] = statistics_json(*run.timing);
    results["roofline"] = json_of(ceilings(machine, *run.timing));
  }
  if (!run.heat_maps.empty()) results["heat_maps"] = json_of(run.heat_maps);
  if (input.recorded) results["surfels"] = surfels_json(*input.recorded, input.skipped, input.estimated);
  if (input.mesh.triangles > 0) results["mesh"] = mesh_json(input.mesh);
  if (input.volume) results["volume"] = volume_json(*input.volume);
  if (run.reference) results["reference"] = reference_json(run.reference->comparison);
  results["host"] = {{"seconds", run.host_seconds}};
  if (run.timing) {
    results["host"]["cycles_per_second"] = static_cast<double>(run.timing->cycles) / run.timing_seconds;
  }
  return results;
}

OnFrame earlier_frames_writer(const Trace& trace, const std::filesystem::path& folder) {
  return [folder, frames = frame_ends(trace).size(), number = std::size_t{0}](const Frame& frame) mutable {
    if (number + 1 < frames) write_png(picture_of(frame), folder / picture_name(number, frames));
    ++number;
  };
}

namespace {

void write_reference(const FrameRun& run, const std::filesystem::path& folder) {
  const Image reference = picture_of(run.reference->picture);
  write_exr(reference, folder / "reference.exr");
  write_png(reference, folder / "reference.png");
  write_png(difference_picture(run.rendered.frame, run.reference->picture), folder / "difference.png");
}

std::vector<std::string> result_names(const Input& input, const FrameRun& run) {
  std::vector<std::string> names{"frame.exr", "depth.exr", "results.json", "report.html"};
  const std::size_t frames = frame_ends(input.trace).size();
  for (std::size_t i = 0; i < frames; ++i) names.push_back(picture_name(i, frames));
  if (run.reference) names.insert(names.end(), {"reference.exr", "reference.png", "difference.png"});
  for (const HeatMap& map : run.heat_maps) names.push_back(map.name + ".exr");
  return names;
}

}  // namespace

void write_run(const Input& input, const Machine& machine, Fidelity fidelity, const FrameRun& run,
               const std::filesystem::path& folder) {
  nlohmann::ordered_json results = results_of(input, machine, fidelity, run);
  const std::vector<std::string> files = result_names(input, run);
  results["files"] = files;
  const Image picture = picture_of(run.rendered.frame);
  remove_earlier_results(folder, files);
  // Side by side: to compress them takes longer than many a frame.
  oneapi::tbb::parallel_invoke(
      [&] { write_exr(picture, folder / "frame.exr"); }, [&] { write_png(picture, folder / "frame.png"); },
      [&] { write_exr(depth_of(run.rendered.frame), folder / "depth.exr"); },
      [&] {
        if (run.reference) write_reference(run, folder);
      },
      [&] {
        for (const HeatMap& map : run.heat_maps) write_exr(map.image, folder / (map.name + ".exr"), "Y");
      },
      [&] { run_report(input, machine, run, results).write(folder / "report.html"); });
  traces::write_file(folder / "results.json", results.dump(1) + "\n");
}

}  // namespace splatscope::studies
