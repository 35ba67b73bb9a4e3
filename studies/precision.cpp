#include "studies/precision.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <mutex>
#include <numbers>

#include "kernels/object_space_ewa/alpha_texture.h"
#include "model/input_file.h"
#include "model/machine/machine.h"
#include "model/render.h"
#include "studies/picture_quality.h"
#include "studies/reference_comparison.h"
#include "traces/gamma.h"
#include "traces/recorder.h"

namespace splatscope::studies {
namespace {

constexpr double kFullCutoff = 8;    // exp(-8) is a tenth of 1/255
constexpr double kFieldOfView = 60;  // degrees

kernels::SplatSums sums_of(traces::Scene scene, double cutoff, bool one_surface) {
  scene.splatting.cutoff = cutoff;
  scene.splatting.circular_cutoff = true;
  if (one_surface) return single_surface_reference(scene);
  return screen_space_reference(scene, kernels::ScreenMap::perspective);
}

// Colours as vertices hold them: their 8 bits are none of the steps.
PrecisionScene with_references(std::string name, traces::Scene scene, bool one_surface) {
  for (traces::Surfel& surfel : scene.surfels) surfel.color = glm::round(surfel.color * 255.0f) / 255.0f;
  const double cutoff = scene.splatting.cutoff;
  return {std::move(name), scene, sums_of(scene, cutoff, one_surface),
          sums_of(scene, kFullCutoff, one_surface)};
}

// Every splat with the same weight, whatever its surroundings.
Frame draw_with_weight(traces::Scene scene, double weight, const NumberFormats& numbers) {
  const traces::CapturedWeights weights = traces::uniform_weights(scene.surfels.size(), weight);
  scene.splatting.algorithm = traces::Algorithm::ewa_per_surfel;
  return render(traces::record(scene, weights).trace, {.formats = numbers, .record = Record::nothing}).frame;
}

// A plane in a grid of spacing 1, seen from so far away.
traces::Scene tilted_plane(double tilt_degrees, int surfels_a_side, double distance, int frame_size) {
  const double tilt = tilt_degrees * std::numbers::pi / 180;
  return traces::parse_scene(
      fmt::format(
          "[surfels]\ngenerator = \"plane\"\ncolumns = {0}\nrows = {0}\nchecker_light = [0.9, 0.8, 0.7]\n"
          "checker_dark = [0.1, 0.15, 0.2]\n"
          "[frame]\nwidth = {1}\nheight = {1}\n"
          "[camera]\neye = [0, {2}, {3}]\ntarget = [0, 0, 0]\nup = [0, {3}, -{2}]\nfov_y_degrees = {5}\n"
          "near = 1\nfar = {4}\n",
          surfels_a_side, frame_size, distance * std::cos(tilt), distance * std::sin(tilt), 4 * distance,
          kFieldOfView),
      "precision-plane");
}

// White splats, so many on each pixel on average, seen from above and beyond every edge of the frame.
traces::Scene overlapping_splats(double count, int frame_size) {
  // A spacing. With a whole number every splat's edge would fall on the same places of its pixels.
  constexpr double kPixels = 6.854;
  const double half_view = 0.5 * frame_size / kPixels;
  const double distance = half_view / std::tan(0.5 * kFieldOfView * std::numbers::pi / 180);
  // At the cutoff 1 a splat is a circle, and r^2 = 2 (h^2 + the prefilter's 1 pixel^2).
  const double radius2 = count / std::numbers::pi;
  const double half_plane = half_view + std::sqrt(radius2) + 1;
  traces::Scene scene = tilted_plane(0, static_cast<int>(2 * half_plane) + 1, distance, frame_size);
  for (traces::Surfel& surfel : scene.surfels) {
    surfel.radius = static_cast<float>(std::sqrt(0.5 * radius2 - 1 / (kPixels * kPixels)));
    surfel.color = {1, 1, 1};
  }
  return scene;
}

// The plane at 45 degrees, green, with waves that it hides nothing of: flat splats of a curved surface.
traces::Scene corrugated_plane(int frame_size) {
  constexpr float kAmplitude = 1, kWaveNumber = std::numbers::pi_v<float> / 8;  // spacings
  traces::Scene scene = precision_plane(45, frame_size, frame_size).scene;
  for (traces::Surfel& surfel : scene.surfels) {
    const float phase = kWaveNumber * surfel.position.x;
    surfel.position.y += kAmplitude * std::sin(phase);
    surfel.normal = glm::normalize(glm::vec3(-kAmplitude * kWaveNumber * std::cos(phase), 1, 0));
    surfel.color = {0, 1, 0};
  }
  return scene;
}

}  // namespace

Errors errors_of(const Frame& frame, const kernels::SplatSums& reference) {
  const double half = 0.5 * median_weight(reference);
  Errors out;
  double squares = 0;
  std::vector<double> largest;
  for (std::size_t pixel = 0; pixel < reference.sums.size(); ++pixel) {
    if (!(reference.sums[pixel].w > 0) || reference.sums[pixel].w < half) continue;
    const Vec4 color = frame.color(pixel);
    double worst = 0, brightest = 0, wanted = 0;
    for (int c = 0; c < 3; ++c) {
      const double value = std::clamp(double{color[static_cast<std::size_t>(c)]}, 0.0, 1.0);
      const double should = reference.normalized[pixel][c];
      squares += (value - should) * (value - should);
      out.bias += value - should;
      worst = std::max(worst, std::abs(value - should));
      brightest = std::max(brightest, value);
      wanted = std::max(wanted, should);
    }
    largest.push_back(255 * worst);
    out.mean += 255 * worst;
    out.saturated += brightest >= 1 && wanted < 254.0 / 255;
    out.black += brightest == 0 && wanted > 1.0 / 255;
  }
  const auto pixels = static_cast<double>(largest.size());
  out.psnr = decibels(squares, 3 * largest.size());
  out.bias *= 255 / (3 * pixels);
  for (double* sum : {&out.mean, &out.saturated, &out.black}) *sum /= pixels;
  if (!largest.empty()) {
    const auto place = largest.begin() + static_cast<std::ptrdiff_t>(0.99 * pixels);
    std::ranges::nth_element(largest, place);
    out.percentile99 = *place;
  }
  return out;
}

Pipeline ideal_pipeline() {
  Pipeline ideal;
  ideal.numbers = {.vertex_arithmetic = Arithmetic::ieee,
                   .color = ColorFormat::float32,
                   .combiner = CombinerFormat::float32,
                   .frame = FrameFormat::float32,
                   .frame_rounding = FrameRounding::nearest,
                   .depth = DepthFormat::float32,
                   .subpixel_bits = 8,
                   .filter_bits = 8,
                   .reciprocal_bits = 24};
  ideal.texel_bits = 16;
  ideal.texture_size = 1024;
  return ideal;
}

Pipeline machine_pipeline() {
  Pipeline pipeline;
  pipeline.numbers = machine::load(machine::kGeForce4).numbers;
  return pipeline;
}

PrecisionScene precision_plane(double tilt_degrees, int surfels_a_side, int frame_size) {
  return with_references(fmt::format("{:.0f} deg", tilt_degrees),
                         tilted_plane(tilt_degrees, surfels_a_side, surfels_a_side, frame_size), true);
}

PrecisionScene precision_model(int surfels, int frame_size) {
  const std::filesystem::path fetched = std::filesystem::path(kModelsFolder) / "armadillo.off";
  const bool there = std::filesystem::exists(fetched);
  const traces::Scene scene = traces::parse_scene(
      fmt::format(
          "[surfels]\n{}\ncount = {}\npattern = \"checker\"\n[frame]\nwidth = {}\nheight = {}\n",
          there ? fmt::format("file = {}", toml_string(fetched.string())) : "generator = \"torus-knot\"",
          surfels, frame_size, frame_size),
      "precision.toml");
  return with_references(there ? "armadillo" : "torus knot", scene, false);
}

Frame draw(const traces::Scene& original, const Pipeline& pipeline) {
  traces::Scene scene = original;
  scene.splatting.cutoff = pipeline.cutoff;
  scene.splatting.circular_cutoff = pipeline.circular;
  scene.splatting.algorithm = pipeline.algorithm;
  scene.splatting.gamma =
      pipeline.gamma > 0 ? pipeline.gamma : traces::suitable_gamma(scene.surfels, scene.splatting);
  scene.capture.corner_weights = pipeline.corner_weights;
  scene.capture.views = 8;
  scene.capture.frame_size = 256;
  Trace trace = traces::record(scene, pipeline.numbers).trace;
  const int size =
      pipeline.texture_size > 0 ? pipeline.texture_size : kernels::optimal_length(pipeline.cutoff);
  const auto shape = pipeline.circular ? kernels::CutoffShape::circle : kernels::CutoffShape::square;
  trace.textures[0] = kernels::alpha_texture(pipeline.cutoff, size, shape, pipeline.texel_bits);
  return render(trace, {.formats = pipeline.numbers, .record = Record::nothing}).frame;
}

std::vector<SwitchRow> switch_rows(std::span<const Switch> switches, std::span<const PrecisionScene> scenes,
                                   const Progress& progress) {
  std::vector<SwitchRow> rows(switches.size());
  std::mutex progress_lock;
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, switches.size(), [&](std::size_t i) {
    SwitchRow row{switches[i], {}, {}};
    for (const PrecisionScene& scene : scenes) {
      const kernels::SplatSums& reference = row.setting.in_full ? scene.full_reference : scene.reference;
      for (const bool alone : {true, false}) {
        Pipeline pipeline = alone ? ideal_pipeline() : machine_pipeline();
        row.setting.turn(pipeline);
        (alone ? row.alone : row.in_machine).push_back(errors_of(draw(scene.scene, pipeline), reference));
      }
    }
    rows[i] = std::move(row);
    const std::lock_guard lock(progress_lock);
    tell(progress, ++done, switches.size());
  });
  return rows;
}

std::vector<OverlapRow> overlap_rows(std::span<const double> overlaps, int frame_size) {
  constexpr double kBrightness = 0.73;
  struct Buffer {
    std::string name;
    FrameFormat format;
    FrameRounding rounding;
  };
  using enum FrameRounding;
  const Buffer buffers[] = {{"unorm8, nearest", FrameFormat::unorm8, nearest},
                            {"unorm8, truncate", FrameFormat::unorm8, truncate},
                            {"unorm8, dither", FrameFormat::unorm8, dither},
                            {"unorm10, nearest", FrameFormat::unorm10, nearest},
                            {"unorm10, dither", FrameFormat::unorm10, dither},
                            {"unorm16, nearest", FrameFormat::unorm16, nearest},
                            {"half", FrameFormat::half, nearest},
                            {"float32", FrameFormat::float32, nearest}};
  std::vector<OverlapRow> rows;
  for (const double count : overlaps) {
    const traces::Scene scene = overlapping_splats(count, frame_size);
    const kernels::SplatSums sums = single_surface_reference(scene);  // of weights gamma
    const double largest = std::ranges::max(sums.sums, {}, &glm::dvec4::w).w;
    const double scale = kBrightness / largest;
    for (const Buffer& buffer : buffers) {
      NumberFormats numbers = ideal_pipeline().numbers;
      numbers.frame = buffer.format;
      numbers.frame_rounding = buffer.rounding;
      const Frame frame = draw_with_weight(scene, scale * scene.splatting.gamma, numbers);
      OverlapRow row{buffer.name, count, 0, 0, 0};
      double pixels = 0;
      for (std::size_t i = 0; i < sums.sums.size(); ++i) {
        if (!(sums.sums[i].w > 0)) continue;
        const double should = sums.sums[i].w * scale;
        const double is = double{frame.color(i)[0]};
        row.bias += 255 * (is - should);
        row.saturated += is >= 1;
        row.black += is == 0;
        ++pixels;
      }
      for (double* sum : {&row.bias, &row.saturated, &row.black}) *sum /= pixels;
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<DepthRow> depth_rows(std::span<const double> offsets, int frame_size) {
  constexpr std::pair<std::string_view, DepthFormat> kFormats[] = {
      {"z16", DepthFormat::z16}, {"z24", DepthFormat::z24}, {"float32", DepthFormat::float32}};
  constexpr float kApart = 4;
  const traces::Scene front = corrugated_plane(frame_size);
  const kernels::SplatSums reference = sums_of(front, front.splatting.cutoff, true);
  traces::Scene both = front;
  for (traces::Surfel surfel : front.surfels) {
    surfel.position.y -= kApart;
    surfel.color = {1, 0, 0};
    both.surfels.push_back(surfel);
  }
  std::vector<DepthRow> rows;
  const double median = median_weight(reference);
  for (const auto& [name, format] : kFormats) {
    for (const double offset : offsets) {
      NumberFormats numbers = ideal_pipeline().numbers;
      numbers.depth = format;
      both.splatting.depth_offset = offset;
      const Frame frame = draw_with_weight(both, front.splatting.gamma, numbers);
      DepthRow row{name, offset, 0, 0, 0};
      double pixels = 0;
      for (std::size_t i = 0; i < reference.sums.size(); ++i) {
        const double whole = reference.sums[i].w;
        if (whole < 0.9 * median) continue;
        const double left = double{frame.color(i)[1]} / whole;
        row.lost += std::max(0.0, 1 - left);
        row.holes += left < 0.5;
        row.leaks += frame.color(i)[0] > 8.0f / 255;
        ++pixels;
      }
      for (double* sum : {&row.lost, &row.holes, &row.leaks}) *sum /= pixels;
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace splatscope::studies
