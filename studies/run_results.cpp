#include "studies/run_results.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_invoke.h>

#include "studies/report/run_report.h"
#include "studies/roofline.h"
#include "studies/run_files.h"

namespace splatscope::studies {
namespace {

using Json = nlohmann::ordered_json;

Json frames_json(const sim::Result& timing) {
  Json out = Json::array();
  for (std::size_t i = 0; i < timing.frame_cycles.size(); ++i) {
    const sim::Cycle cycles = timing.frame_cycles[i];
    Json frame = {{"cycles", cycles},
                  {"milliseconds", 1000 * timing.seconds_of(cycles)},
                  {"frames_per_second", timing.frames_per_second(cycles)}};
    if (!timing.frame_plus_minus.empty()) frame["cycles_plus_minus"] = timing.frame_plus_minus[i];
    // Of the whole run; an estimate has no events.
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
    {"triangles_clipped", "triangles", "that clipping made more than one of, not culled",
     &RenderCounters::triangles_clipped},
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

// Statistics of units ("texture.lookups") are there where the unit is, in a fidelity that counts in units.
bool is_counted(const std::string& counter, const FrameRun& run) {
  if (counter.find('.') == std::string::npos) return true;
  return run.timing && std::ranges::any_of(run.timing->statistics, [&](const sim::UnitStatistic& statistic) {
           return statistic.unit_name + "." + statistic.name == counter;
         });
}

Json heat_maps_json(const FrameRun& run) {
  Json out = Json::array();
  for (const HeatMap& map : run.heat_maps) {
    out.push_back({{"name", map.name},
                   {"file", map.name + ".exr"},
                   {"unit", map.unit},
                   {"what", map.what},
                   {"frame_pixels", map.scale},
                   {"sum", map.sum}});
    if (is_counted(map.counter, run)) out.back()["counter"] = map.counter;
  }
  return out;
}

Json mesh_json(const traces::MeshCounts& mesh) {
  return {{"triangles", mesh.triangles},
          {"triangles_not_finite", mesh.triangles_not_finite},
          {"triangles_out_of_range", mesh.triangles_out_of_range},
          {"triangles_degenerate", mesh.triangles_degenerate},
          {"normals_computed", mesh.normals_computed},
          {"textures_unreadable", mesh.textures_unreadable},
          {"materials_unreadable", mesh.materials_unreadable}};
}

Json blocks_json(const traces::BlockCounts& blocks) {
  return {{"drawn", blocks.blocks},
          {"surfels_by_level", blocks.surfels_by_level},
          {"surfels_outside_frustum", blocks.outside_frustum},
          {"surfels_facing_away", blocks.facing_away}};
}

Json surfels_json(const traces::RecordCounts& recorded, const traces::SkipCounts& skipped,
                  const traces::EstimateCounts& estimated) {
  return {{"total", recorded.scene_surfels},
          {"drawn", recorded.surfels},
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

void write_reference(const FrameRun& run, const ResultFiles& files) {
  const Image reference = picture_of(run.reference->picture);
  write_exr(reference, files.place("reference.exr"));
  write_png(reference, files.place("reference.png"));
  write_png(difference_picture(run.rendered.frame, run.reference->picture), files.place("difference.png"));
}

}  // namespace

nlohmann::ordered_json timing_json(const sim::Result& timing) {
  return {{"frames", frames_json(timing)},
          {"units", units_json(timing)},
          {"units_left_out", left_out_json(timing)}};
}

nlohmann::ordered_json programs_json(const Trace& trace) {
  Json programs = Json::array();
  for (const ShaderText& program : trace.programs)
    programs.push_back({{"name", program.name}, {"slots", slots_of(program)}});
  return programs;
}

nlohmann::ordered_json settings_json(const Machine& machine) {
  Json settings = Json::object();
  for (const machine::ParameterValue& parameter : machine::describe(machine))
    if (parameter.origin.confidence == "set") settings[parameter.name] = unquoted(parameter.value);
  return settings;
}

std::string unquoted(std::string_view value) {
  const bool is_quoted = value.size() >= 2 && value.starts_with('"') && value.ends_with('"');
  return std::string(is_quoted ? value.substr(1, value.size() - 2) : value);
}

nlohmann::ordered_json results_of(const Input& input, const Machine& machine, Fidelity fidelity,
                                  const FrameRun& run) {
  Json results;
  results["input"] = input.name;
  results["machine"] = machine.name;
  results["set"] = settings_json(machine);
  results["fidelity"] = name(fidelity);
  if (run.seed) results["seed"] = *run.seed;
  results["frames"] = frames_json(run, frame_ends(input.trace).size());
  results["programs"] = programs_json(input.trace);
  results["units"] = run.timing ? units_json(*run.timing) : Json::array();
  results["units_left_out"] = run.timing ? left_out_json(*run.timing) : Json::array();
  results["counters"] = counters_json(run.rendered.counters);
  results["totals"] = totals_json(run.rendered.counters);
  if (run.timing) {
    results["statistics"] = statistics_json(*run.timing);
    results["roofline"] = json_of(ceilings(machine, *run.timing));
  }
  if (!run.heat_maps.empty()) results["heat_maps"] = heat_maps_json(run);
  if (input.recorded) results["surfels"] = surfels_json(*input.recorded, input.skipped, input.estimated);
  if (input.mesh.triangles > 0) results["mesh"] = mesh_json(input.mesh);
  if (input.volume) results["volume"] = volume_json(*input.volume);
  if (run.reference) results["reference"] = json_of(run.reference->comparison);
  results["host"] = {{"seconds", run.host_seconds}};
  if (run.timing) {
    results["host"]["cycles_per_second"] = static_cast<double>(run.timing->cycles) / run.host_seconds;
  }
  return results;
}

OnFrame earlier_frames_writer(const Trace& trace, const ResultFiles& files) {
  return [&files, frames = frame_ends(trace).size(), number = std::size_t{0}](const Frame& frame) mutable {
    if (number + 1 < frames) write_png(picture_of(frame), files.place(picture_name(number, frames)));
    ++number;
  };
}

std::vector<std::string> write_run(const Input& input, const Machine& machine, Fidelity fidelity,
                                   const FrameRun& run, ResultFiles& files) {
  const nlohmann::ordered_json results = results_of(input, machine, fidelity, run);
  const Image picture = picture_of(run.rendered.frame);
  // Side by side: to compress them takes longer than many a frame.
  oneapi::tbb::parallel_invoke(
      [&] { write_exr(picture, files.place("frame.exr")); },
      [&] { write_png(picture, files.place("frame.png")); },
      [&] { write_exr(depth_of(run.rendered.frame), files.place("depth.exr")); },
      [&] {
        if (run.reference) write_reference(run, files);
      },
      [&] {
        for (const HeatMap& map : run.heat_maps) write_exr(map.image, files.place(map.name + ".exr"), "Y");
      },
      [&] { run_report(input, machine, run, results).write(files.place("report.html")); });
  return files.commit(results);
}

}  // namespace splatscope::studies
