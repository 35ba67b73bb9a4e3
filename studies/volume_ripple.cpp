#include "studies/volume_ripple.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/reference/volume/procedural.h"
#include "kernels/reference/volume/volume_rendering.h"

namespace splatscope::studies {
namespace {

constexpr double kCutoffs[] = {4, 6, 9, 11, 14};
constexpr double kPitches[] = {0.53, 1.03, 1.57, 2.11, 4.3, 9.7};  // no whole numbers: pixels lie anywhere

}  // namespace

double layer_ripple(double cutoff, double pitch) {
  constexpr int kFrame = 256;
  constexpr double kOpacity = 0.5;
  // Wider than the picture by more than any splat reaches.
  const int voxels = static_cast<int>(1.5 * kFrame / pitch + 8 * std::sqrt(1 + 1 / (pitch * pitch))) + 2;
  const kernels::TransferFunction glass({{0, {kOpacity, glm::dvec3(1)}}});
  kernels::View view = kernels::look_at({0, 0, 100}, {0, 0, 0}, {0.3, 1, 0}, 40, kFrame, kFrame, 1, 1000);
  view.eta = pitch;
  const kernels::VolumePicture picture = volume_picture(
      view, grid_splats(kernels::constant_volume({voxels, voxels, 1}, glm::dvec3(1)), glass),
      {.projection = kernels::Projection::orthographic, .cutoff = cutoff, .light = {}, .axis = {}});
  double most = 0;
  for (const glm::dvec4& pixel : picture.pixels) most = std::max(most, std::abs(pixel.w / kOpacity - 1));
  return most;
}

void study_volume_ripple(Findings& findings, const Progress& progress) {
  findings.report().heading("A layer of constant voxels by the cutoff of its splats");
  std::string text =
      "volume-ripple  largest deviation of a layer's opacity, by pixels between voxels\n  cutoff";
  for (const double pitch : kPitches) text += fmt::format(" {:>7.2f}px", pitch);
  auto json = nlohmann::ordered_json::array();
  std::size_t done = 0;
  for (const double cutoff : kCutoffs) {
    text += fmt::format("\n  {:>6}", cutoff);
    for (const double pitch : kPitches) {
      const double ripple = layer_ripple(cutoff, pitch);
      text += fmt::format(" {:>8.2f}%", 100 * ripple);
      json.push_back({{"cutoff", cutoff}, {"pitch", pitch}, {"ripple", ripple}});
    }
    tell(progress, ++done, std::size(kCutoffs));
  }
  findings.text(text + "\n");
  findings.result("volume_ripple", std::move(json));
}

}  // namespace splatscope::studies
