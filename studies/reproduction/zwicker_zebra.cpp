#include <fmt/format.h>

#include <utility>

#include "kernels/reference/volume/fast_volume.h"
#include "kernels/reference/volume/procedural.h"
#include "studies/reproduction/zwicker_volumes.h"
#include "studies/volume_pictures.h"

// Fig. 14 and 15: zebra textures, three voxels thick.
namespace splatscope::studies {
namespace {

using kernels::VolumePrefilter;

constexpr int kLayers = 3;
constexpr double kPeriod = 0.11;  // of the stripes; the square is two units wide
constexpr int kMargin = 5;        // pixels at the picture's edge, where the references lack neighbours
constexpr glm::dvec3 kBackground{0.35, 0.4, 0.5};

// Opaque, black and white, without light.
const kernels::TransferFunction kPaint({{0, {1, {0, 0, 0}}}, {1, {1, {1, 1, 1}}}});
constexpr kernels::PhongLight kNoLight{.ambient = 1, .diffuse = 0, .specular = 0};

Image splatted(kernels::FastVolume& volume, const kernels::View& view, VolumePrefilter prefilter) {
  // The texture's own layers are its sheets, however flat the view: its rows would hide one another.
  return picture_of(volume.draw(view, {.prefilter = prefilter, .light = kNoLight, .axis = 2}), kBackground);
}

kernels::View oblique(int frame) {
  return kernels::look_at({0, -2.1, 0.75}, {0, -0.25, 0}, {0, 0, 1}, 45, frame, frame, 0.01, 100);
}

// The square fills the frame, a little turned.
kernels::View frontal(int frame) {
  return kernels::look_at({0, 0, 4}, {0, 0, 0}, {0.26, 1, 0}, 32, frame, frame, 0.01, 100);
}

}  // namespace

std::vector<ZebraCase> zebra_cases(int texture, int frame) {
  std::vector<ZebraCase> cases;
  for (const int ratio : {1, 2, 4}) {
    // The coarse axis runs across an oblique picture, where its kernels stay long.
    cases.push_back({fmt::format("oblique-{}to1", ratio), texture / ratio, texture, oblique(frame)});
    cases.push_back({fmt::format("frontal-{}to1", ratio), texture / ratio, texture, frontal(frame)});
  }
  return cases;
}

ZebraRow compare_prefilters(const ZebraCase& zebra) {
  kernels::FastVolume volume(
      grid_splats(kernels::zebra_texture(zebra.columns, zebra.rows, kLayers, kPeriod), kPaint));
  ZebraRow row;
  row.ewa = splatted(volume, zebra.view, VolumePrefilter::ewa);
  row.swan = splatted(volume, zebra.view, VolumePrefilter::swan);
  const Image fine = splatted(volume, finer(zebra.view), VolumePrefilter::none);
  row.reference = low_passed(fine, LowPass::gaussian);
  const Image box = low_passed(fine, LowPass::box);
  row.psnr_ewa = psnr_inside(row.ewa, row.reference, kMargin);
  row.psnr_swan = psnr_inside(row.swan, row.reference, kMargin);
  row.psnr_ewa_box = psnr_inside(row.ewa, box, kMargin);
  row.psnr_swan_box = psnr_inside(row.swan, box, kMargin);
  return row;
}

KernelRow compare_kernels(int texture, const kernels::View& view) {
  const kernels::Volume zebra = kernels::zebra_texture(texture, texture, kLayers, kPeriod);
  kernels::FastVolume volume(grid_splats(zebra, kPaint));
  kernels::FastVolume surface(
      grid_splats(zebra, kPaint, 1, {.low = 0, .high = 1, .normal = glm::dvec3(0, 0, 1)}));
  KernelRow row;
  row.volume = splatted(volume, view, VolumePrefilter::ewa);
  row.surface = splatted(surface, view, VolumePrefilter::ewa);
  const double front = zebra.spacing.z;  // of three opaque layers the last is seen
  row.reference = low_passed(zebra_picture(finer(view), front, kPeriod, kBackground), LowPass::gaussian);
  row.psnr_volume = psnr_inside(row.volume, row.reference, kMargin);
  row.psnr_surface = psnr_inside(row.surface, row.reference, kMargin);
  return row;
}

void reproduce_zwicker_figure14(Findings& findings, const Progress& progress) {
  findings.report().heading("Zwicker 2002, Fig. 14: EWA volume splatting and Swan's uniform scaling");
  std::string text = fmt::format("zwicker-fig14 {:>8} {:>10} {:>8} {:>8} {:>8}   {:>8} {:>8}\n", "ratio",
                                 "view", "EWA", "Swan", "ahead", "EWA box", "Swan box");
  auto json = nlohmann::ordered_json::array();
  const std::vector<ZebraCase> cases = zebra_cases(1024, 256);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const ZebraCase& zebra = cases[i];
    ZebraRow row = compare_prefilters(zebra);
    const int ratio = zebra.rows / zebra.columns;
    text += fmt::format(
        "              {:>6}:1 {:>10} {:>5.1f} dB {:>5.1f} dB {:>5.1f} dB   {:>5.1f} dB {:>5.1f} dB\n", ratio,
        zebra.name.substr(0, zebra.name.find('-')), row.psnr_ewa, row.psnr_swan, row.psnr_ewa - row.psnr_swan,
        row.psnr_ewa_box, row.psnr_swan_box);
    json.push_back({{"case", zebra.name},
                    {"texture", {zebra.columns, zebra.rows, kLayers}},
                    {"axis_ratio", ratio},
                    {"psnr_ewa", row.psnr_ewa},
                    {"psnr_swan", row.psnr_swan},
                    {"psnr_ewa_box", row.psnr_ewa_box},
                    {"psnr_swan_box", row.psnr_swan_box}});
    if (ratio > 1) {
      findings.pictures({{"zwicker-fig14-" + zebra.name + "-ewa", fmt::format("EWA, {:.1f} dB", row.psnr_ewa),
                          std::move(row.ewa)},
                         {"zwicker-fig14-" + zebra.name + "-swan",
                          fmt::format("Swan, {:.1f} dB", row.psnr_swan), std::move(row.swan)},
                         {"zwicker-fig14-" + zebra.name + "-reference", "64 samples a pixel, filtered",
                          std::move(row.reference)}});
    }
    tell(progress, i + 1, cases.size());
  }
  findings.text(text);
  findings.result("zwicker_fig14", std::move(json));
}

void reproduce_zwicker_figure15(Findings& findings, const Progress& progress) {
  findings.report().heading("Zwicker 2002, Fig. 15: volume kernels and surface kernels");
  KernelRow row = compare_kernels(512, oblique(320));
  findings.text(
      fmt::format("zwicker-fig15  volume kernels {:.1f} dB, surface kernels {:.1f} dB against the texture\n",
                  row.psnr_volume, row.psnr_surface));
  findings.result("zwicker_fig15", {{"texture", {512, 512, kLayers}},
                                    {"psnr_volume", row.psnr_volume},
                                    {"psnr_surface", row.psnr_surface}});
  findings.pictures(
      {{"zwicker-fig15-volume", fmt::format("volume kernels, {:.1f} dB", row.psnr_volume),
        std::move(row.volume)},
       {"zwicker-fig15-surface", fmt::format("surface kernels, {:.1f} dB", row.psnr_surface),
        std::move(row.surface)},
       {"zwicker-fig15-reference", "the texture, 64 samples a pixel, filtered", std::move(row.reference)}});
  if (progress) progress(1);
}

}  // namespace splatscope::studies
