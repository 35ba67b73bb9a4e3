#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/progress_bar.h"
#include "model/error.h"
#include "traces/models/patterns.h"
#include "traces/output_files.h"
#include "traces/point_file.h"
#include "traces/surfels.h"

namespace splatscope::app {
namespace {

struct Options {
  traces::SurfelSource source = traces::default_settings().surfels;
  std::string pattern = "own";
  std::string out;
};

// What CLI::Range lets pass.
std::string refuse_nan(const std::string& text) {
  if (!std::isnan(std::strtod(text.c_str(), nullptr))) return {};
  return fmt::format("\"{}\", expected a number", text);
}

void sample(const Options& options, bool quiet) {
  if (options.source.pattern_scale != traces::default_settings().surfels.pattern_scale &&
      !traces::has_scale(options.source.pattern))
    throw UserError("--pattern-scale", 0,
                    "without squares, stripes or spots, expected it removed, or another --pattern");
  const std::vector<traces::NamedFile> written{{"-o", options.out}};
  traces::expect_apart(written, {{"MESH", options.source.file}});
  { const traces::OutputFile writable(options.out); }  // before the work, not after it
  traces::SampledModel sampled;
  {
    ProgressBar progress("sampling", quiet);
    sampled = traces::sample_source(
        options.source, "", progress.callback(),
        [&](const std::vector<traces::NamedFile>& read) { traces::expect_apart(written, read); });
  }
  traces::write_ply(sampled.surfels, options.out);
  std::cout << fmt::format("{}: {}\n", options.out, traces::describe(sampled));
}

}  // namespace

void add_sample_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("sample", "a mesh as a file of surfels");
  const auto options = std::make_shared<Options>();
  traces::SurfelSource& source = options->source;
  const auto names = traces::pattern_names();
  command->add_option("MESH", source.file, "any mesh that assimp reads: .obj, .off, .ply, .stl, .gltf, ...")
      ->required();
  command->add_option("-n", source.count, "surfels, exactly")
      ->default_val(traces::kMeshSurfels)
      ->check(CLI::Range(1, 1 << 24));
  command->add_option("-o", options->out, "surfel file to write (PLY)")->required();
  command->add_option("--pattern", options->pattern, "solid pattern; own: the colours that the mesh has")
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())))
      ->capture_default_str();
  command
      ->add_option("--pattern-scale", source.pattern_scale,
                   "size of a square, stripe or spot, in radii of the model")
      ->check(CLI::Range(1e-4, 10.0))
      ->check(refuse_nan)
      ->capture_default_str();
  command->add_option("--shading", source.shading, "how far what faces away from the light is darkened")
      ->check(CLI::Range(0.0, 1.0))
      ->check(refuse_nan)
      ->capture_default_str();
  command->footer("Example: splatscope sample models/bunny.obj -n 50000 --pattern checker -o bunny.ply");
  command->callback([=, &invocation] {
    const auto chosen = std::ranges::find(names, options->pattern) - names.begin();
    options->source.pattern = static_cast<traces::Pattern>(chosen);
    sample(*options, invocation.quiet);
  });
}

}  // namespace splatscope::app
