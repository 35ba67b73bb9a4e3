#include <fmt/format.h>

#include "studies/reference_comparison.h"
#include "studies/reproduction/reproduction.h"
#include "studies/run.h"

namespace splatscope::studies {

void reproduce_figure11(Findings& findings, const Progress& progress) {
  constexpr std::pair<std::string_view, std::string_view> kParts[] = {
      {"no-ewa", "a) without EWA filtering"},
      {"ewa-per-pixel", "b) EWA, normalised per pixel"},
      {"ewa-per-surfel", "c) EWA, normalised per surfel"},
  };
  const Machine machine = machine::load("geforce4-ti4400");
  // EWA in double precision, whatever the algorithm.
  const kernels::ReferencePicture reference =
      scene_reference(traces::load_scene("checkerboard-ewa-per-pixel"));
  std::vector<Findings::Comparison> pictures;
  for (const auto& [algorithm, caption] : kParts) {
    const double done = static_cast<double>(pictures.size()) / std::size(kParts);
    const auto scene = traces::load_scene(fmt::format("checkerboard-{}", algorithm));
    const Trace trace =
        traces::record(scene, machine.numbers, part(progress, done, done + 1.0 / std::size(kParts))).trace;
    const FrameRun run = run_frame(trace, machine, Fidelity::functional);
    const Frame& frame = run.rendered.frame;
    pictures.push_back({fmt::format("fig11-{}", algorithm), std::string(caption), picture_of(frame),
                        picture_of(reference), difference_picture(frame, reference)});
  }
  findings.report().heading("Fig. 11: the three algorithms");
  findings.compare(pictures);
}

}  // namespace splatscope::studies
