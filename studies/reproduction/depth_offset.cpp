#include "studies/reproduction/depth_offset.h"

#include <fmt/format.h>

#include "traces/recorder.h"

namespace splatscope::studies {
namespace {

constexpr std::string_view kSchemes[] = {"viewing-ray", "camera-z"};

nlohmann::ordered_json json_of(const FragmentCounts& counts) {
  return {{"fragments", counts.fragments},
          {"wrongly_hidden", counts.wrongly_hidden},
          {"wrongly_kept", counts.wrongly_kept},
          {"holes", counts.holes},
          {"inside_pixels", counts.inside_pixels}};
}

}  // namespace

traces::Scene with_offset(traces::Scene scene, traces::DepthOffsetScheme scheme, double z_t) {
  scene.splatting.depth_offset = z_t;
  scene.splatting.depth_offset_scheme = scheme;
  // Fragments are found by their surfels' order, and the rule knows no front.
  scene.hierarchy.culling = traces::Culling::none;
  scene.splatting.faces = traces::Faces::both;
  return scene;
}

OffsetRun run_with_offset(const traces::Scene& scene, traces::DepthOffsetScheme scheme, double z_t,
                          const traces::CapturedWeights& weights, const Machine& machine,
                          const VisibleSurface& surface) {
  const traces::Scene drawn = with_offset(scene, scheme, z_t);
  Trace trace = traces::record(drawn, weights).trace;
  Rendered rendered = render(trace, render_options(machine));
  const FragmentCounts counts = count_fragments(drawn, trace, rendered, surface);
  return {std::move(trace), std::move(rendered), counts};
}

void compare_schemes(const std::string& name, const traces::Scene& scene,
                     const traces::CapturedWeights& weights, const Machine& machine,
                     const VisibleSurface& surface, Findings& findings) {
  const auto run = [&](traces::DepthOffsetScheme scheme) {
    return run_with_offset(scene, scheme, scene.splatting.depth_offset, weights, machine, surface);
  };
  std::array<OffsetRun, 2> runs{run(traces::DepthOffsetScheme::viewing_ray),
                                run(traces::DepthOffsetScheme::camera_z)};
  std::vector<Findings::Picture> pictures, wrong;
  std::string text = fmt::format("{:<5} {:<12} {:>10} {:>15} {:>13} {:>6} of {}\n", name, "scheme",
                                 "fragments", "wrongly hidden", "wrongly kept", "holes", "pixels");
  auto results = nlohmann::ordered_json{{"depth_offset", scene.splatting.depth_offset}};
  for (const std::size_t i : {1u, 0u}) {  // as in the paper: a) along camera z, b) along viewing rays
    const FragmentCounts& counts = runs[i].counts;
    const std::string scheme(kSchemes[i]);
    pictures.push_back({name + "-" + scheme, fmt::format("{}) z_t by {}", i == 1 ? "a" : "b", scheme),
                        picture_of(runs[i].rendered.frame)});
    wrong.push_back({name + "-" + scheme + "-wrong",
                     fmt::format("{}: fragments wrongly hidden (red) and wrongly kept (blue)", scheme),
                     wrong_pixels(scene, runs[i].trace, runs[i].rendered, surface)});
    text += fmt::format("{:<5} {:<12} {:>10} {:>15} {:>13} {:>6} of {}\n", name, scheme, counts.fragments,
                        counts.wrongly_hidden, counts.wrongly_kept, counts.holes, counts.inside_pixels);
    results[scheme] = json_of(counts);
  }
  findings.pictures(pictures);
  findings.pictures(wrong);
  findings.text(text);
  findings.result(name, std::move(results));
}

}  // namespace splatscope::studies
