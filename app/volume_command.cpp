#include <iostream>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/progress_bar.h"
#include "studies/run_files.h"
#include "studies/volume_run.h"

namespace splatscope::app {

void add_volume_command(CLI::App& app, Invocation& invocation) {
  struct Options {
    std::string scene;
    std::string precision = "single";
    std::string out = "out";
  };
  CLI::App* command =
      app.add_subcommand("volume", "a volume by EWA splatting, in software (Zwicker et al. 2002)");
  const auto options = std::make_shared<Options>();
  command
      ->add_option("SCENE", options->scene, "scene file (TOML) with [volume], or the name of a ready scene")
      ->required();
  command->add_option("--precision", options->precision, "the fast renderer, or its yardstick")
      ->check(CLI::IsMember({"single", "double"}))
      ->capture_default_str();
  command->add_option("--out", options->out, "folder for the results")->capture_default_str();
  command->footer("Example: splatscope volume volume-head --out out/head");
  command->callback([options, &invocation] {
    studies::expect_apart_from_results({{"SCENE", options->scene}}, options->out);
    const auto precision = options->precision == "single" ? studies::Precision::single_precision
                                                          : studies::Precision::double_precision;
    const traces::VolumeScene scene = traces::load_volume_scene(options->scene);
    studies::expect_apart_from_results(scene.files, options->out);
    std::string text;
    {
      ProgressBar progress("drawing", invocation.quiet);
      text = studies::run_volume(scene, precision, options->out, progress.callback());
    }
    std::cout << text;
  });
}

}  // namespace splatscope::app
