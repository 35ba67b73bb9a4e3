#include "studies/volume_run.h"

#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "kernels/reference/volume/fast_volume.h"
#include "kernels/reference/volume/volume_rendering.h"
#include "studies/image_io.h"
#include "studies/measure.h"
#include "studies/result_files.h"
#include "studies/volume_pictures.h"
#include "traces/output_files.h"

namespace splatscope::studies {
namespace {

kernels::FastVolumePicture in_single(const kernels::VolumePicture& exact) {
  kernels::FastVolumePicture picture{exact.width, exact.height, {}, exact.left_out, exact.sheets};
  picture.pixels.assign(exact.pixels.begin(), exact.pixels.end());
  return picture;
}

// Why there is nothing to see, where no splat is drawn.
std::string warning_of_none(std::size_t drawn, std::size_t left_out) {
  if (drawn > 0) return "";
  return fmt::format("warning: no splat is drawn, so the picture is its background: {}\n",
                     left_out > 0
                         ? "each is before the near plane, beyond the far plane, outside of the picture, or "
                           "without a finite footprint"
                         : "no voxel has any opacity, or a cell of any size");
}

}  // namespace

std::string run_volume(const traces::VolumeScene& scene, Precision precision,
                       const std::filesystem::path& folder, const Progress& progress) {
  const traces::OutputFolder made(folder);
  ResultFiles files(folder);
  const auto start = HostClock::now();
  kernels::FastVolume volume(scene.splats());
  const double classify_seconds = seconds_since(start);
  const std::size_t empty = volume.splats().empty;
  const auto frame_start = HostClock::now();
  const std::clock_t processor_start = std::clock();
  const kernels::FastVolumePicture picture =
      precision == Precision::single_precision
          ? volume.draw(scene.view, scene.settings, progress)
          : in_single(volume_picture(scene.view, volume.splats(), scene.settings, progress));
  const std::size_t splats = volume.splats().splats.size() - picture.left_out;
  const double frame_seconds = seconds_since(frame_start);
  const double processor_seconds =
      static_cast<double>(std::clock() - processor_start) / static_cast<double>(CLOCKS_PER_SEC);
  const Image image = picture_of(picture, scene.background);
  write_png(image, files.place("frame.png"));
  write_exr(image, files.place("frame.exr"));
  const glm::ivec3 size = scene.volume.size;
  const nlohmann::ordered_json results = {{"volume", {{"size", {size.x, size.y, size.z}}, {"empty", empty}}},
                                          {"splats", splats},
                                          {"left_out", picture.left_out},
                                          {"sheets", picture.sheets},
                                          {"host",
                                           {{"classify_seconds", classify_seconds},
                                            {"frame_seconds", frame_seconds},
                                            {"frame_processor_seconds", processor_seconds}}}};
  files.commit(results, 2);
  return fmt::format(
      "{}: {}, {} of them empty\n"
      "{} splats in {} sheets, {} left out\n"
      "{}"
      "{} x {} pixels: {:.2f} s a frame, {:.2f} s of processor time; {:.2f} s before it to classify the "
      "voxels\n"
      "{}\n",
      scene.name,
      scene.samples.empty() ? fmt::format("{} x {} x {} voxels", size.x, size.y, size.z)
                            : fmt::format("{} samples", scene.samples.size()),
      empty, splats, picture.sheets, picture.left_out, warning_of_none(splats, picture.left_out),
      picture.width, picture.height, frame_seconds, processor_seconds, classify_seconds,
      (folder / "frame.png").string());
}

}  // namespace splatscope::studies
