#include "studies/reproduction/figure11.h"

#include <fmt/format.h>

#include "studies/reference_comparison.h"
#include "studies/run.h"

namespace splatscope::studies {

CheckerboardPicture draw_checkerboard(const traces::Scene& scene, const kernels::SplatSums& reference,
                                      const Machine& machine, const Progress& progress) {
  Frame frame = draw_frame(scene, machine, progress);
  const double decibels = psnr(frame, reference);
  return {std::move(frame), decibels};
}

void reproduce_figure11(Findings& findings, const Progress& progress) {
  constexpr std::pair<std::string_view, std::string_view> kParts[] = {
      {"no-ewa", "a) without EWA filtering"},
      {"ewa-per-pixel", "b) EWA, normalised per pixel"},
      {"ewa-per-surfel", "c) EWA, normalised per surfel"},
  };
  const Machine machine = machine::load(machine::kGeForce4);
  // EWA in double precision, whatever the algorithm.
  const kernels::SplatSums reference =
      single_surface_reference(traces::load_scene("checkerboard-ewa-per-pixel"));
  std::vector<Findings::Comparison> pictures;
  auto list = nlohmann::ordered_json::array();
  std::string text;
  for (const auto& [algorithm, caption] : kParts) {
    const double done = static_cast<double>(pictures.size()) / std::size(kParts);
    const auto scene = traces::load_scene(fmt::format("checkerboard-{}", algorithm));
    const CheckerboardPicture drawn =
        draw_checkerboard(scene, reference, machine, part(progress, done, done + 1.0 / std::size(kParts)));
    pictures.push_back({fmt::format("fig11-{}", algorithm), std::string(caption), picture_of(drawn.frame),
                        picture_of(reference), difference_picture(drawn.frame, reference)});
    text += fmt::format("fig11 {:<15} {:>5.1f} dB against EWA in double precision\n", algorithm, drawn.psnr);
    list.push_back({{"algorithm", algorithm}, {"psnr_decibels", drawn.psnr}});
  }
  findings.report().heading("Fig. 11: the three algorithms");
  findings.text(text);
  findings.compare(pictures);
  findings.result("fig11", list);
}

}  // namespace splatscope::studies
