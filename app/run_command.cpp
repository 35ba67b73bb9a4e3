#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <iostream>
#include <memory>

#include "app/commands.h"
#include "app/machine_options.h"
#include "app/progress_bar.h"
#include "model/error.h"
#include "studies/own_program.h"
#include "studies/reference_comparison.h"
#include "studies/run.h"
#include "studies/run_files.h"
#include "studies/run_observers.h"
#include "studies/run_results.h"
#include "traces/output_files.h"

namespace splatscope::app {
namespace {

// The cycle of the next row is a sum of 64 bits, which must not overflow: 2^63 would do. This number can be
// read, and no run comes near it: at 300 MHz it is nearly an hour of the machine's time.
constexpr std::uint64_t kMostCyclesARow = 1'000'000'000'000;

struct Options {
  std::string input;
  MachineOptions machine;
  std::string fidelity = "cycle";
  std::uint64_t seed = 1;
  std::string out = "out";
  std::optional<std::string> reference;
  studies::ObserveOptions observe;
  bool heat_maps = false;
};

// Of the capture, where there was one.
void print_weights(const traces::RecordCounts& counts) {
  const std::size_t all = counts.weights_captured + counts.weights_by_default + counts.weights_outside_box;
  if (all == 0) return;
  std::cout << fmt::format(
      "  weights{}: {} captured, {} of them a vertex; {} seen from no view, {} outside "
      "of the box\n",
      all != counts.scene_surfels ? " of all levels" : "", counts.weights_captured, counts.weights_at_edges,
      counts.weights_by_default, counts.weights_outside_box);
  if (counts.weights_captured == 0 && counts.weights_by_default > 0)
    std::cout
        << "  warning: no view of the capture shows a surfel, so no weight is captured and the picture is "
           "not normalised: the splats may be too faint for the frame buffer (splatting.sigma, "
           "splatting.gamma), or the views too few (capture.views)\n";
}

void print(const studies::Input& input, const Machine& machine, const studies::FrameRun& run) {
  const std::size_t frames = frame_ends(input.trace).size();
  std::cout << fmt::format("{} on {}\n", input.name, machine.title);
  if (input.recorded)
    std::cout << fmt::format("  {} surfels, {}\n", input.recorded->scene_surfels,
                             traces::describe(input.skipped, input.estimated));
  if (input.recorded && !input.recorded->blocks.surfels_by_level.empty())
    std::cout << fmt::format("  {}{}\n", frames > 1 ? fmt::format("in the last of {} frames: ", frames) : "",
                             traces::describe(input.recorded->blocks));
  if (input.recorded) print_weights(*input.recorded);
  if (input.volume) std::cout << fmt::format("  {}\n", traces::describe(*input.volume));
  if (input.mesh.triangles > 0) std::cout << fmt::format("  {}\n", traces::describe(input.mesh));
  const RenderCounters& c = run.rendered.counters;
  std::cout << fmt::format(
      "  {} vertices shaded, {} triangles, {} fragments, of these {} passed the depth test\n", c.vertices,
      c.triangles, c.fragments, c.fragments_passed);
  std::cout << fmt::format(
      "  triangles dropped: {} outside the frustum, {} before the near plane, {} back-facing, {} not "
      "finite\n",
      c.triangles_outside, c.triangles_behind, c.triangles_back_facing, c.triangles_not_finite);
  if (c.fragments == 0)
    std::cout << "  warning: no triangle covers a pixel, so nothing is drawn and the picture is what it was "
                 "cleared to\n";
  if (!run.timing) return;
  std::cout << fmt::format("  {}, {:.2f} ms, {:.1f} frames a second\n",
                           studies::text_of_cycles(run.timing->frame_cycles.size(), run.timing->cycles,
                                                   run.timing->cycles_plus_minus),
                           1000 * run.timing->seconds, run.timing->frames_per_second());
  for (const auto& unit : run.timing->units_left_out)
    std::cout << fmt::format("  left out: {}: {}\n", unit.name, unit.why);
}

void print(const studies::Comparison& c) {
  std::cout << "  against the reference: " << studies::describe_psnr(c);
  if (c.pixels_off_edges > 0)
    std::cout << fmt::format(", {:.1f} dB over the {} of them off edges", c.psnr_off_edges,
                             c.pixels_off_edges);
  if (c.surface_pixels > 0) std::cout << fmt::format(", at worst {:.0f}/255", c.worst);
  if (c.inside_pixels > 0)
    std::cout << fmt::format(", {} of {} pixels inside the silhouette are holes", c.holes, c.inside_pixels);
  if (c.rounded_to_black > 0)
    std::cout << fmt::format(", {} more are covered and rounded to black", c.rounded_to_black);
  std::cout << '\n';
}

bool simulates_cycles(studies::Fidelity fidelity) {
  return fidelity == studies::Fidelity::cycle || fidelity == studies::Fidelity::referee;
}

// That no file of the command line is written over another, nor over one of `files`.
void expect_apart(const Options& options, std::vector<traces::NamedFile> files) {
  const auto named = options.machine.files_with(options.input);
  files.insert(files.end(), named.begin(), named.end());
  const studies::ObserveOptions& observe = options.observe;
  for (const auto& [what, path] : {std::pair{"--timeline", &observe.timeline},
                                   {"--pipeline", &observe.pipeline},
                                   {"--counters", &observe.counters}}) {
    if (path->empty()) continue;
    traces::expect_apart({{what, *path}}, files);
    files.push_back({what, *path});
  }
  studies::expect_apart_from_results(files, options.out);
}

// Of a trace of many frames only how many.
std::string listed(const std::vector<std::string>& files) {
  constexpr std::size_t kMostNames = 12;
  return files.size() > kMostNames ? fmt::format("{} files", files.size())
                                   : fmt::format("{}", fmt::join(files, ", "));
}

// That the fidelity can write the files that are asked for. A seed may be given to any: one that takes no
// samples gives the same result by every seed.
void expect_used(const Options& options, studies::Fidelity fidelity) {
  if (options.observe.asks_for_cycles() && !simulates_cycles(fidelity)) {
    throw UserError(
        "--fidelity", 0,
        fmt::format("{} simulates no cycles to show, expected cycle or referee", options.fidelity));
  }
}

void run(const Options& options, bool quiet) {
  expect_apart(options, {});
  const Machine machine = options.machine.machine();
  machine::check(machine);
  const studies::Fidelity fidelity = studies::fidelity_by_name(options.fidelity);
  expect_used(options, fidelity);
  std::optional<kernels::ScreenMap> map;
  if (options.reference) map = studies::screen_map_by_name(*options.reference);
  const traces::OutputFolder folder(options.out);  // first: the files below may lie in it
  studies::ResultFiles files(options.out);
  studies::check(options.observe);
  ProgressBar loading("loading", quiet);
  auto opened = studies::open_input(options.input, loading.callback());
  loading.clear();
  expect_apart(options, studies::files_of(opened));
  if (map) studies::expect_reference(opened, *map, options.input);
  std::optional<kernels::ScreenSpacePicture> reference;
  if (map) reference = studies::reference_of(opened, *map);
  ProgressBar recording("recording", quiet);
  studies::start_threads();
  studies::Input input = studies::make_input(std::move(opened), options.input, machine, recording.callback());
  recording.clear();
  const std::vector<std::string> replaced = studies::replace_programs(input.trace, options.machine.programs);
  if (fidelity == studies::Fidelity::sampled || simulates_cycles(fidelity))
    sim::expect_countable_time(input.trace, machine);
  studies::RunObservers observers(options.observe, input.trace);
  std::optional<studies::HeatMaps> heat_maps;
  std::vector<sim::Observer*> watching(observers.observers().begin(), observers.observers().end());
  if (options.heat_maps) {
    heat_maps.emplace(input.trace, simulates_cycles(fidelity));
    if (heat_maps->observer()) watching.push_back(heat_maps->observer());
  }
  ProgressBar running("running", quiet);
  studies::FrameRun result = studies::run_frame(
      input.trace, machine, fidelity, running.callback(), studies::earlier_frames_writer(input.trace, files),
      {.seed = options.seed, .observers = watching, .heat_maps = heat_maps ? &*heat_maps : nullptr});
  running.clear();
  if (reference) {
    const studies::Comparison comparison =
        studies::compare(result.rendered.frame, input.trace, machine, *reference);
    result.reference = {std::move(*reference), comparison};
  }
  const std::vector<std::string> observed = observers.commit(result.timing ? result.timing->cycles : 0);
  const std::vector<std::string> written = studies::write_run(input, machine, fidelity, result, files);
  print(input, machine, result);
  for (const std::string& line : replaced) std::cout << "  " << line << '\n';
  if (result.reference) print(result.reference->comparison);
  std::cout << fmt::format("  {} in {}\n", listed(written), options.out);
  for (const std::string& line : observed) std::cout << "  " << line << '\n';
}

void add_observe_options(CLI::App& command, studies::ObserveOptions& observe) {
  CLI::Option* timeline = command.add_option("--timeline", observe.timeline,
                                             "a file for Perfetto: what each unit did when, queues, memory");
  const auto add_window = [&command](const char* name, sim::LogWindow& window, CLI::Option* of) {
    const auto take = [name, &window](const std::string& text) { window = studies::window_of(text, name); };
    command.add_option_function<std::string>(name, take, "FIRST:LAST: core cycles that it shows")->needs(of);
  };
  add_window("--timeline-window", observe.timeline_window, timeline);
  CLI::Option* pipeline = command.add_option(
      "--pipeline", observe.pipeline,
      "a file for Konata: each instruction of the vertex units, when it waited and issued");
  add_window("--pipeline-window", observe.pipeline_window, pipeline);
  CLI::Option* counters = command.add_option("--counters", observe.counters,
                                             "a table (CSV) of shares, statistics and queues over time");
  command.add_option("--counters-every", observe.counters_every, "core cycles a row of it")
      ->needs(counters)
      ->check(CLI::Range(std::uint64_t{1}, kMostCyclesARow))
      ->capture_default_str();
}

}  // namespace

void add_run_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("run", "the frame or frames of a scene or trace on one machine");
  const auto options = std::make_shared<Options>();
  command->add_option("INPUT", options->input, "scene file (TOML), name of a ready scene, or FILE.trace")
      ->required();
  options->machine.add_to(*command);
  command->add_option("--fidelity", options->fidelity, "functional, throughput, sampled, cycle or referee")
      ->capture_default_str();
  add_seed_option(*command, options->seed);
  command->add_option("--out", options->out, "folder for the results; those of an earlier run in it go away")
      ->capture_default_str();
  command
      ->add_option("--reference", options->reference,
                   "also draw the scene in double precision and compare the frame with it: affine (the "
                   "screen-space filter, Ren 2002, Eq. 5) or perspective (the exact map)")
      ->expected(0, 1)
      ->default_str("affine");
  add_observe_options(*command, options->observe);
  command->add_flag("--heat-maps", options->heat_maps,
                    "also write where in the frame the work was: overdraw.exr, depth_fails.exr, "
                    "texel_fetches.exr, and where cycles are simulated cycles_per_tile.exr");
  command->footer(
      "Example: splatscope run checkerboard-ewa-per-surfel --set vertex.units=4 --out out/four-units");
  command->callback([options, &invocation] { run(*options, invocation.quiet); });
}

}  // namespace splatscope::app
