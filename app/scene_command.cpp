#include <iostream>

#include "app/commands.h"
#include "traces/scene_keys.h"

namespace splatscope::app {

void add_scene_command(CLI::App& app) {
  CLI::App* scene = app.add_subcommand("scene", "about scene files");
  scene->require_subcommand(1);
  scene->footer("Example: splatscope scene keys");
  CLI::App* keys = scene->add_subcommand("keys", "every key of a scene file, as a Markdown table");
  keys->footer("Example: splatscope scene keys");
  keys->callback([] { std::cout << traces::describe_keys(); });
}

}  // namespace splatscope::app
