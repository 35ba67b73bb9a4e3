#include <algorithm>
#include <iostream>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/machine_options.h"
#include "app/progress_bar.h"
#include "model/error.h"
#include "studies/explain.h"
#include "studies/own_program.h"
#include "studies/run.h"
#include "traces/words.h"

namespace splatscope::app {
namespace {

struct Options {
  std::string input;
  MachineOptions machine;
  std::string pixel, vertex;
};

// "12,34". Throws UserError naming `option`.
std::pair<std::uint32_t, std::uint32_t> two_numbers(const std::string& text, const char* option,
                                                    const char* what) {
  const std::string_view view = text;
  const std::size_t comma = std::min(view.find(','), view.size());
  const auto first = traces::number_of<std::uint32_t>(view.substr(0, comma));
  const auto second = traces::number_of<std::uint32_t>(view.substr(std::min(comma + 1, view.size())));
  if (first && second) return {*first, *second};
  throw UserError(option, 0, "\"" + text + "\", expected " + what);
}

void explain(const Options& options, bool quiet) {
  std::pair<std::uint32_t, std::uint32_t> pixel, vertex;
  if (!options.pixel.empty()) pixel = two_numbers(options.pixel, "--pixel", "X,Y, a pixel from the top left");
  if (!options.vertex.empty())
    vertex = two_numbers(options.vertex, "--vertex", "D,I, a draw and an index, both from 0");
  const Machine machine = options.machine.machine();
  machine::check(machine);
  ProgressBar loading("loading", quiet);
  auto opened = studies::open_input(options.input, loading.callback());
  loading.clear();
  ProgressBar recording("recording", quiet);
  studies::Input input = studies::make_input(std::move(opened), options.input, machine, recording.callback());
  recording.clear();
  for (const std::string& line : studies::replace_programs(input.trace, options.machine.programs))
    std::cout << line << '\n';
  if (!options.pixel.empty()) {
    ProgressBar drawing("drawing", quiet);
    const auto steps =
        studies::explain_pixel(input.trace, machine.numbers, pixel.first, pixel.second, drawing.callback());
    drawing.clear();
    std::cout << studies::describe(input.trace, machine.numbers, steps);
  }
  if (!options.vertex.empty())
    std::cout << studies::explain_vertex(input.trace, machine.numbers, vertex.first, vertex.second);
}

}  // namespace

void add_explain_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("explain", "what made a pixel, or what a vertex program did");
  const auto options = std::make_shared<Options>();
  command->add_option("INPUT", options->input, "FILE.trace, scene file, or name of a ready scene")
      ->required();
  options->machine.add_to(*command);
  auto* what = command->add_option_group("what");
  what->add_option(
      "--pixel", options->pixel,
      "X,Y: every triangle that covers it, in order: depth test, diffuse, texel, frame before and after");
  what->add_option("--vertex", options->vertex,
                   "D,I: the vertex program of index I in draw D, by instruction");
  what->require_option(1, 2);
  command->footer("Example: splatscope explain checkerboard-ewa-per-surfel --pixel 256,400");
  command->callback([options, &invocation] { explain(*options, invocation.quiet); });
}

}  // namespace splatscope::app
