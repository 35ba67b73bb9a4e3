// Whole frames of the paper's scene: what the machine computes against the double-precision reference, and
// the two schedulers against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "ewa_bounds.h"
#include "kernels/object_space_ewa/alpha_texture.h"
#include "kernels/sphere_points.h"
#include "studies/reference_comparison.h"
#include "studies/run.h"
#include "traces/splat_trace.h"

namespace splatscope::studies {
namespace {

traces::Scene paper_scene(traces::Algorithm algorithm) {
  traces::Scene scene = traces::parse_scene("", "paper.toml");
  scene.splatting.algorithm = algorithm;
  return scene;
}

// The same view at a quarter of the size: 64 x 64 surfels in 128 x 128 pixels.
traces::Scene reduced_scene(traces::Algorithm algorithm) {
  traces::Scene scene = traces::parse_scene(
      "[surfels]\ncolumns = 64\nrows = 64\n[frame]\nwidth = 128\nheight = 128\n"
      "[camera]\neye = [0, 17.5, 56.25]\ntarget = [0, 0, 7.5]\n",
      "reduced.toml");
  scene.splatting.algorithm = algorithm;
  return scene;
}

Rendered drawn(const traces::Scene& scene, const NumberFormats& formats) {
  RenderOptions options;
  options.formats = formats;
  options.record = Record::nothing;
  return render(traces::record(scene, formats).trace, options);
}

NumberFormats float_formats() {
  NumberFormats formats;
  formats.color = ColorFormat::float32;
  formats.frame = FrameFormat::float32;
  return formats;
}

// Half a diagonal of the 1/16-pixel grid, and a texel of the alpha texture: one pixel moves y by at most 1.
tests::SurfaceAgreement agreement(const Frame& frame, const traces::Scene& scene, bool eight_bit_texels) {
  const tests::Leave leave{.cutoff_tolerance = 2 * std::numbers::sqrt2 / kernels::optimal_length(1),
                           .edge_tolerance = std::numbers::sqrt2 / 32,
                           .texture_length = eight_bit_texels ? traces::texture_length(scene.splatting) : 0};
  return tests::agreement(frame, single_surface_reference(scene),
                          tests::ewa_bounds(traces::view_of(scene.camera, scene.frame),
                                            reference_surfels(scene), filter_of(scene), leave));
}

// The proof of the function: with float arithmetic and frame buffer only the 8-bit texture and the edges'
// grid are left between the machine and Eq. 8.
TEST(Frames, FloatPictureIsTheReference) {
  const traces::Scene scene = paper_scene(traces::Algorithm::ewa_per_pixel);
  const Frame frame = drawn(scene, float_formats()).frame;
  const tests::SurfaceAgreement exact = agreement(frame, scene, false);
  EXPECT_GT(exact.surface.pixels, 60000u);
  EXPECT_EQ(0u, exact.surface.outside) << "worst " << exact.surface.worst << "/255";
  const tests::SurfaceAgreement with_texels = agreement(frame, scene, true);
  EXPECT_EQ(0u, with_texels.surface.outside + with_texels.fringe.outside)
      << "worst " << with_texels.surface.worst << ", " << with_texels.fringe.worst << " /255";
}

// Normalised per pixel, what is left is the rounding of some nine splats to steps of 1/255 each, divided by
// their weight of about 0.7: 1.2 steps (root mean square), 46 dB. Per surfel, weights that are the same in
// all of a splat ripple between the centres.
TEST(Frames, EightBitPicturesComeNearTheReference) {
  const kernels::SplatSums reference =
      single_surface_reference(paper_scene(traces::Algorithm::ewa_per_pixel));
  for (const char* name : {"geforce4-ti4400", "radeon-8500"}) {
    const NumberFormats formats = machine::load(name).numbers;
    const auto decibels = [&](traces::Algorithm algorithm) {
      return psnr(drawn(paper_scene(algorithm), formats).frame, reference);
    };
    const double per_surfel = decibels(traces::Algorithm::ewa_per_surfel);
    EXPECT_GE(decibels(traces::Algorithm::ewa_per_pixel), 45) << name;
    EXPECT_GE(per_surfel, 31) << name;
    EXPECT_LT(decibels(traces::Algorithm::no_ewa), per_surfel - 6) << name << ": clearly worse without EWA";
  }
}

// Points spread evenly over a unit sphere, coloured by a pattern; the eye at a distance of 3.
traces::Scene sphere_scene() {
  constexpr int kPoints = 6000;
  traces::Scene scene = traces::parse_scene(
      "[surfels]\ncolumns = 1\nrows = 1\n[frame]\nwidth = 160\nheight = 160\n"
      "[camera]\neye = [1, 1, 2.6]\ntarget = [0, 0, 0]\nfov_y_degrees = 45\nnear = 1\nfar = 5\n"
      "[splatting]\nalgorithm = \"ewa-per-pixel\"\ngamma = 0.6\n",
      "sphere.toml");
  const double spacing = kernels::sphere_spacing(kPoints);
  scene.splatting.depth_offset = spacing;
  scene.surfels.clear();
  for (int i = 0; i < kPoints; ++i) {
    const glm::dvec3 place = kernels::sphere_point(i, kPoints).place;
    traces::Surfel surfel;
    surfel.position = surfel.normal = place;
    surfel.radius = static_cast<float>(std::numbers::sqrt2 * spacing);
    surfel.color = glm::vec3(std::sin(9 * place.z) > 0 ? 0.9 : 0.2,
                             std::sin(4 * std::atan2(place.y, place.x)) > 0 ? 0.8 : 0.3, 0.5);
    scene.surfels.push_back(surfel);
  }
  return scene;
}

// A closed surface: back faces, silhouettes and the depth test, beside what the plane shows. A float machine
// differs by its 8-bit texture and by single fragments whose depth or edge falls on the other side.
TEST(Frames, ClosedSurfaceComesNearTheScreenSpaceReference) {
  const traces::Scene scene = sphere_scene();
  const kernels::ScreenSpacePicture reference =
      screen_space_reference(scene, kernels::ScreenMap::perspective);
  const Comparison exact = compare(drawn(scene, float_formats()).frame, reference);
  const Comparison eight_bit =
      compare(drawn(scene, machine::load("geforce4-ti4400").numbers).frame, reference);
  EXPECT_GT(exact.surface_pixels, 10000u);
  EXPECT_GE(exact.psnr,
            45.5);  // 45.8: a pixel of the silhouette, where quads seen edge-on are cut, is worth 0.1
  EXPECT_GE(eight_bit.psnr, 36);
  EXPECT_EQ(exact.holes, 0u);
  EXPECT_EQ(eight_bit.holes, 0u);
  const Comparison affine = compare(drawn(scene, float_formats()).frame, screen_space_reference(scene));
  EXPECT_GE(affine.psnr, 40);
  EXPECT_LT(affine.psnr, exact.psnr) << "the map is the difference";
}

class ReducedFrame : public testing::TestWithParam<std::tuple<std::string, traces::Algorithm>> {};

TEST_P(ReducedFrame, SchedulersAgreeAndBooksAddUp) {
  const auto& [name, algorithm] = GetParam();
  const Machine machine = machine::load(name);
  const Trace trace = traces::record(reduced_scene(algorithm), machine.numbers).trace;
  const FrameRun fast = run_frame(trace, machine, Fidelity::cycle);
  const FrameRun slow = run_frame(trace, machine, Fidelity::referee);
  EXPECT_EQ(slow.timing->event_hash, fast.timing->event_hash);
  EXPECT_EQ(slow.timing->cycles, fast.timing->cycles);
  EXPECT_EQ(slow.timing->command_ends, fast.timing->command_ends);
  EXPECT_EQ(slow.rendered.frame, fast.rendered.frame);
  ASSERT_EQ(slow.timing->units.size(), fast.timing->units.size());
  for (std::size_t i = 0; i < fast.timing->units.size(); ++i) {
    const sim::UnitBooks &a = fast.timing->units[i], &b = slow.timing->units[i];
    EXPECT_EQ(fast.timing->cycles, a.busy + a.starved + a.blocked + a.idle) << a.name;
    EXPECT_EQ(std::tuple(b.busy, b.starved, b.blocked, b.idle),
              std::tuple(a.busy, a.starved, a.blocked, a.idle))
        << a.name;
    const auto add = [](sim::Cycle sum, const auto& by) { return sum + by.second; };
    EXPECT_EQ(a.blocked, std::accumulate(a.blocked_by.begin(), a.blocked_by.end(), sim::Cycle{0}, add))
        << a.name;
  }
}

// What docs/fidelity.md promises of each way to time a frame.
TEST_P(ReducedFrame, ThroughputComesWithinTenPercentOfTheCycles) {
  const auto& [name, algorithm] = GetParam();
  const Machine machine = machine::load(name);
  const Trace trace = traces::record(reduced_scene(algorithm), machine.numbers).trace;
  const FrameRun estimate = run_frame(trace, machine, Fidelity::throughput);
  const FrameRun simulated = run_frame(trace, machine, Fidelity::cycle);
  EXPECT_NEAR(
      1.0, static_cast<double>(estimate.timing->cycles) / static_cast<double>(simulated.timing->cycles), 0.1);
  EXPECT_EQ(estimate.rendered.frame, simulated.rendered.frame);
}

// A machine with every unit that it can have times a frame like the one with what the frame needs.
TEST_P(ReducedFrame, WhatWasLeftOutChangesNothing) {
  const auto& [name, algorithm] = GetParam();
  const Machine machine = machine::load(name);
  const Trace trace = traces::record(reduced_scene(algorithm), machine.numbers).trace;
  const FrameRun run = run_frame(trace, machine, Fidelity::cycle);
  const sim::Result& needed = *run.timing;
  const Rendered rendered = render(trace, render_options(machine));
  const sim::Result all =
      sim::simulate(trace, rendered.work, machine, sim::Scheduler::skip_ahead, {}, {}, sim::UnitChoice::all);
  EXPECT_EQ(rendered.frame, run.rendered.frame);
  EXPECT_GT(all.units.size(), needed.units.size());
  EXPECT_EQ(all.event_hash, needed.event_hash);
  EXPECT_EQ(all.cycles, needed.cycles);
  EXPECT_EQ(all.command_ends, needed.command_ends);
  for (const sim::UnitBooks& books : needed.units) {
    const auto same = std::ranges::find(all.units, books.name, &sim::UnitBooks::name);
    ASSERT_NE(same, all.units.end()) << books.name;
    EXPECT_EQ(same->busy, books.busy) << books.name;
    EXPECT_EQ(same->blocked_by, books.blocked_by) << books.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table1, ReducedFrame,
    testing::Combine(testing::Values(std::string("geforce4-ti4400"), std::string("radeon-8500")),
                     testing::Values(traces::Algorithm::no_ewa, traces::Algorithm::ewa_per_pixel,
                                     traces::Algorithm::ewa_per_surfel)));

// What the frame needs of a machine does not change its picture, nor does the machine's timing.
TEST(Frames, TimingDoesNotTouchThePicture) {
  const Machine machine = machine::load("geforce4-ti4400");
  const Trace trace = traces::record(reduced_scene(traces::Algorithm::ewa_per_surfel), machine.numbers).trace;
  Machine slower = machine;
  machine::set(slower, "memory.banks=1");
  machine::set(slower, "vertex.units=1");
  const FrameRun a = run_frame(trace, machine, Fidelity::cycle),
                 b = run_frame(trace, slower, Fidelity::cycle);
  EXPECT_EQ(a.rendered.frame, b.rendered.frame);
  EXPECT_EQ(a.rendered.frame, run_frame(trace, machine, Fidelity::functional).rendered.frame);
  EXPECT_GT(b.timing->cycles, a.timing->cycles * 3 / 2);
}

class VolumeFrame : public testing::TestWithParam<std::string> {};

// A volume, which is drawn by way of an off-screen surface.
TEST_P(VolumeFrame, IsTheSoftwaresAndSchedulersAgree) {
  const Machine machine = machine::load(GetParam());
  const traces::VolumeScene scene = traces::parse_volume_scene(
      "[volume]\ngenerator = \"head\"\nvoxels = [20, 20, 9]\ncutoff = 4\nsurface_low = 0.6\n"
      "surface_high = 1\nbackground = [0.1, 0.2, 0.3]\n[frame]\nwidth = 48\nheight = 48\n",
      "head.toml");
  const Trace trace = traces::record(scene).trace;
  const FrameRun fast = run_frame(trace, machine, Fidelity::cycle);
  const FrameRun slow = run_frame(trace, machine, Fidelity::referee);
  EXPECT_EQ(slow.timing->event_hash, fast.timing->event_hash);
  EXPECT_EQ(slow.timing->cycles, fast.timing->cycles);
  EXPECT_EQ(slow.rendered.frame, fast.rendered.frame);
  const Comparison picture = compare(fast.rendered.frame, volume_reference(scene));
  EXPECT_GT(picture.surface_pixels, 500u);
  EXPECT_GT(picture.psnr, 36);
  EXPECT_NEAR(static_cast<double>(fast.rendered.frame.color(0)[2]), 0.3, 0.6 / 255)
      << "the background, half a step off";
}
INSTANTIATE_TEST_SUITE_P(Machines, VolumeFrame, testing::Values("geforce4-ti4400", "radeon-8500"),
                         [](const auto& info) { return info.index == 0 ? "geforce4" : "radeon"; });

}  // namespace
}  // namespace splatscope::studies
