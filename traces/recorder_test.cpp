#include "traces/recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "kernels/reference/screen_space.h"
#include "kernels/splat_programs.h"
#include "model/render.h"
#include "traces/splat_trace.h"
#include "traces/trace_file.h"
#include "traces/weight_capture.h"

namespace splatscope::traces {
namespace {

Scene small_plane(Algorithm algorithm) {
  Scene scene = parse_scene(
      "[surfels]\ncolumns = 24\nrows = 20\n[frame]\nwidth = 64\nheight = 64\n"
      "[camera]\neye = [0, 14, -20]\ntarget = [0, 0, 0]\n",
      "plane.toml");
  scene.splatting.algorithm = algorithm;
  return scene;
}

TEST(Recorder, TangentsSpanTheSurfel) {
  std::mt19937 random(1);
  std::normal_distribution<float> any;
  for (int i = 0; i < 100; ++i) {
    Surfel surfel;
    surfel.normal = glm::normalize(glm::vec3(any(random), any(random), any(random)));
    surfel.radius = 2.5f;
    const auto [s, t] = tangents(surfel);
    EXPECT_NEAR(2.5, glm::length(s), 1e-12);
    EXPECT_NEAR(2.5, glm::length(t), 1e-12);
    EXPECT_NEAR(0, glm::dot(s, t), 1e-12);
    EXPECT_NEAR(0, glm::dot(s, glm::dvec3(surfel.normal)), 1e-6);
  }
}

TEST(Recorder, EveryAlgorithmIsASoundTraceOfTwoPasses) {
  for (const Algorithm algorithm : {Algorithm::no_ewa, Algorithm::ewa_per_pixel, Algorithm::ewa_per_surfel}) {
    const Trace trace = record(small_plane(algorithm), NumberFormats{}).trace;
    EXPECT_NO_THROW(check_trace(trace, "recorded"));
    EXPECT_EQ(trace.buffers[0].bytes.size(), 24u * 20 * 6 * 2)
        << "indices of 16 bits for these surfels alone";
    const bool per_pixel = algorithm == Algorithm::ewa_per_pixel;
    ASSERT_EQ(per_pixel ? 4u : 3u, trace.commands.size());
    EXPECT_FALSE(std::get<Draw>(trace.commands[1]).state.color_write);
    EXPECT_FALSE(std::get<Draw>(trace.commands[2]).state.depth_write);
    EXPECT_EQ(per_pixel, std::holds_alternative<NormalizeOnHost>(trace.commands.back()));

    const Rendered rendered = render(trace, {});
    EXPECT_EQ(2u * 4 * 24 * 20,
              rendered.counters.vertices);  // four a surfel and pass: two of six indices hit
    EXPECT_EQ(2u * 2 * 24 * 20, rendered.counters.triangles);
    EXPECT_GT(rendered.counters.fragments_passed, 1000u);
  }
}

double psnr(const splatscope::Frame& frame, const kernels::SplatSums& reference) {
  double squares = 0;
  std::size_t channels = 0;
  for (std::size_t pixel = 0; pixel < reference.sums.size(); ++pixel) {
    if (reference.sums[pixel].w < 0.3) continue;  // at the border of the surface or beyond
    for (int i = 0; i < 3; ++i, ++channels) {
      const double off = frame.color(pixel)[static_cast<std::size_t>(i)] - reference.normalized[pixel][i];
      squares += off * off;
    }
  }
  return -10 * std::log10(squares / static_cast<double>(channels));
}

std::vector<splatscope::Frame> frames_of(const Trace& trace) {
  std::vector<splatscope::Frame> frames;
  render(trace, {}, {}, [&](const splatscope::Frame& frame) { frames.push_back(frame); });
  return frames;
}

// Per surfel while the eye moves, per pixel when it rests. Of greys, whose sums look right where the alpha
// channel alone saturates and the division does nothing.
TEST(Recorder, RefinesAFramePerSurfelByOnePerPixel) {
  Scene scene = parse_scene(
      "[surfels]\ncolumns = 24\nrows = 20\nchecker_light = [0.6, 0.6, 0.6]\n"
      "checker_dark = [0.3, 0.3, 0.3]\n[frame]\nwidth = 64\nheight = 64\n"
      "[camera]\neye = [0, 14, -20]\ntarget = [0, 0, 0]\n[splatting]\ngamma = 0.6\n",
      "greys.toml");
  for (const kernels::SplatProgram& program : kernels::ewa_programs()) {
    scene.splatting.ewa_program = program.name;
    scene.splatting.algorithm = Algorithm::ewa_per_surfel;
    scene.splatting.refine = true;
    const Trace trace = record(scene, NumberFormats{}).trace;
    EXPECT_NO_THROW(check_trace(trace, "recorded"));
    const std::vector<splatscope::Frame> refined = frames_of(trace);
    ASSERT_EQ(2u, refined.size());
    scene.splatting.refine = false;
    EXPECT_EQ(frames_of(record(scene, NumberFormats{}).trace), std::vector{refined[0]}) << program.name;
    scene.splatting.algorithm = Algorithm::ewa_per_pixel;
    EXPECT_EQ(frames_of(record(scene, NumberFormats{}).trace), std::vector{refined[1]}) << program.name;

    std::vector<kernels::Surfel> surfels;
    for (const Surfel& surfel : scene.surfels) {
      const auto [s, t] = tangents(surfel);
      surfels.push_back({glm::dvec3(surfel.position), s, t, scene.splatting.sigma, scene.splatting.gamma,
                         glm::dvec3(surfel.color)});
    }
    const kernels::ScreenSpacePicture reference =
        kernels::screen_space_ewa(view_of(scene.camera, scene.frame), surfels,
                                  {.filter = {.prefilter = true,
                                              .cutoff = scene.splatting.cutoff,
                                              .shape = kernels::CutoffShape::circle},
                                   .depth_offset = scene.splatting.depth_offset});
    EXPECT_LT(psnr(refined[0], reference), 32) << program.name;
    EXPECT_GT(psnr(refined[1], reference), 36) << program.name;
  }
}

// Only what the refined frame draws has vertices of its own, with the level's gamma as weight.
TEST(Recorder, RefinesTheLastOfProgressiveFrames) {
  Scene scene = small_plane(Algorithm::ewa_per_surfel);
  scene.hierarchy.culling = Culling::blocks;
  scene.hierarchy.block_surfels = 16;
  scene.hierarchy.progressive = true;
  const Trace coarse_to_fine = record(scene, NumberFormats{}).trace;
  const std::vector<splatscope::Frame> progressive = frames_of(coarse_to_fine);
  ASSERT_GT(progressive.size(), 1u);
  scene.splatting.refine = true;
  const Trace with_still_frame = record(scene, NumberFormats{}).trace;
  EXPECT_EQ(with_still_frame.buffers.size(), coarse_to_fine.buffers.size() + 1);
  std::vector<splatscope::Frame> refined = frames_of(with_still_frame);
  scene.hierarchy.progressive = false;
  scene.splatting.refine = false;
  scene.splatting.algorithm = Algorithm::ewa_per_pixel;
  EXPECT_EQ(frames_of(record(scene, NumberFormats{}).trace), std::vector{refined.back()});
  refined.pop_back();
  EXPECT_EQ(progressive, refined);
}

TEST(Recorder, DrawsInBatchesOfSixteenBitIndices) {
  Scene scene = small_plane(Algorithm::ewa_per_pixel);
  scene.surfels.resize(20000, scene.surfels.front());
  const Trace trace = record(scene, NumberFormats{}).trace;
  ASSERT_EQ(6u, trace.commands.size());
  EXPECT_EQ(16384u * 6, std::get<Draw>(trace.commands[1]).index_count);
  EXPECT_EQ(16384u * 4, std::get<Draw>(trace.commands[2]).base_vertex);
  EXPECT_EQ((20000u - 16384u) * 6, std::get<Draw>(trace.commands[2]).index_count);
}

// Camera z of what the visibility pass left at a pixel.
double depth_at(const splatscope::Frame& frame, const Camera& camera, std::size_t x, std::size_t y) {
  const double depth = frame.depth_value(y * frame.width + x);
  return camera.near / (1 - depth * (camera.far - camera.near) / camera.far);
}

// A wall 10 units away, seen with an angle of 90 degrees: where a ray leaves the axis by r, it is sqrt(1 +
// r^2) times as long.
TEST(Recorder, DepthMovesAlongTheRayOrTheCamerasAxis) {
  Scene scene = small_plane(Algorithm::ewa_per_pixel);
  scene.camera = {{0, 10, 0}, {0, 0, 0}, {0, 0, 1}, 90, 5, 20};
  scene.frame = {21, 21};
  scene.splatting.depth_offset = 2;
  for (const std::string_view program : {"quad", "corner"}) {
    scene.splatting.visibility_program = program;
    scene.splatting.depth_offset_scheme = DepthOffsetScheme::viewing_ray;
    const Trace along_ray = record(scene, NumberFormats{}).trace;
    scene.splatting.depth_offset_scheme = DepthOffsetScheme::camera_z;
    const Trace along_z = record(scene, NumberFormats{}).trace;
    EXPECT_EQ(along_ray.programs[0].text, along_z.programs[0].text) << "as many slots";
    EXPECT_EQ(std::get<Draw>(along_ray.commands[2]).constants, std::get<Draw>(along_z.commands[2]).constants)
        << "the splats stay where they are";
    const auto frame_of = [](const Trace& trace) { return render(trace, {}).frame; };
    const kernels::View view = view_of(scene.camera, scene.frame);
    const splatscope::Frame ray = frame_of(along_ray), z = frame_of(along_z);
    for (const std::size_t x : {4u, 10u, 16u}) {
      const glm::dvec2 off = (glm::dvec2(static_cast<double>(x), 10) + 0.5 - view.center()) / view.eta;
      EXPECT_NEAR(12, depth_at(z, scene.camera, x, 10), 1e-4);
      // Quads are flat, with corners 2 units from their middles: 2 - 2 / sqrt(1 + 0.2^2) = 0.04 nearer there
      // on the axis, somewhat more beside it.
      const double exact = 10 + 2 / std::sqrt(1 + glm::dot(off, off)),
                   drawn = depth_at(ray, scene.camera, x, 10);
      EXPECT_LT(drawn, exact);
      EXPECT_GT(drawn, exact - 0.06);
    }
  }
}

TEST(Recorder, TextureIsAsLongAsTheSceneSays) {
  Scene scene = small_plane(Algorithm::ewa_per_pixel);
  EXPECT_EQ(438u, record(scene, NumberFormats{}).trace.textures[0].width) << "Eq. 16 for c = 1";
  scene.splatting.texture_length = 64;
  const Trace trace = record(scene, NumberFormats{}).trace;
  EXPECT_EQ(64u, trace.textures[0].width);
  EXPECT_EQ(64u * 64, trace.textures[0].texels.size());
}

// 20,000 surfels of 224 bytes in two buffers, the first of 3.5 MiB, and indices for one.
TEST(Recorder, VertexBuffersLieInVideoMemoryAsFarAsItGoes) {
  Scene scene = small_plane(Algorithm::ewa_per_pixel);
  scene.surfels.resize(20000, scene.surfels.front());
  scene.hierarchy = {Culling::off, 256};
  const auto places = [&] {
    std::vector<MemoryPlace> places;
    for (const Buffer& buffer : record(scene, NumberFormats{}).trace.buffers) places.push_back(buffer.place);
    return places;
  };
  using enum MemoryPlace;
  EXPECT_EQ(places(), (std::vector{video, video, video}));
  scene.splatting.video_megabytes = 4;
  EXPECT_EQ(places(), (std::vector{video, video, agp}));
  scene.splatting.video_megabytes = 0;
  EXPECT_EQ(places(), (std::vector{agp, agp, agp}));
  scene.splatting.vertex_memory = VertexMemory::video;
  EXPECT_EQ(places(), (std::vector{video, video, video}));
}

// At a surfel of a square grid with h = sqrt 2 spacings the weights within the cutoff sum to (1 + 4 exp(-1/4)
// + 4 exp(-1/2)) / 2 pi = 1.041; four more of exp(-1) lie on the cutoff itself and may count: 1.275.
TEST(Recorder, CapturedWeightsAreTheInverseSums) {
  const Scene scene = small_plane(Algorithm::no_ewa);
  NumberFormats formats;
  formats.frame = FrameFormat::float32;
  formats.color = ColorFormat::float32;
  const CapturedWeights captured = capture_weights(scene, formats);
  EXPECT_EQ(scene.surfels.size(), captured.captured);
  for (std::size_t row = 3; row < 17; ++row) {
    for (std::size_t column = 3; column < 21; ++column) {
      const float weight = captured.weights[row * 24 + column][0];
      EXPECT_GT(weight, 0.99 / 1.275);
      EXPECT_LT(weight, 1.01 / 1.041);
    }
  }
  EXPECT_GT(captured.weights[0][0], 1.5f);  // a corner has a quarter of the neighbours
}

double psnr(const splatscope::Frame& a, const splatscope::Frame& b) {
  double squares = 0;
  const std::size_t pixels = std::size_t{a.width} * a.height;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    for (std::size_t i = 0; i < 3; ++i) squares += std::pow(a.color(pixel)[i] - b.color(pixel)[i], 2.0);
  }
  return -10 * std::log10(squares / (3.0 * static_cast<double>(pixels)));
}

// At the edges of a plane the corners of a quad have weights of their own. A short program's quads lie
// otherwise than the paper's, but whichever way the plane faces each corner has about the weight that belongs
// where it is drawn.
TEST(Recorder, CornersKeepTheirWeightsInEveryProgram) {
  const Scene plane = parse_scene(
      "[surfels]\ncolumns = 12\nrows = 12\nchecker_light = [1, 1, 1]\nchecker_dark = [1, 1, 1]\n"
      "[frame]\nwidth = 64\nheight = 64\n[splatting]\nalgorithm = \"ewa-per-surfel\"\n"
      "[capture]\nviews = 8\nframe_size = 128\n",
      "plane.toml");
  for (int turn = 0; turn < 3; ++turn) {
    for (const float side : {1.0f, -1.0f}) {
      const auto turned = [&](glm::vec3 p) {
        for (int i = 0; i < turn; ++i) p = {p.z, p.x, p.y};
        return p;
      };
      Scene scene = plane;
      for (Surfel& surfel : scene.surfels) {
        surfel.position = turned(surfel.position);
        surfel.normal = turned(surfel.normal);
      }
      scene.camera.eye = turned({2, side * 12, -6});
      scene.camera.target = turned({0, 0, 0});
      scene.camera.up = turned({0, 0, 1});
      const splatscope::Frame paper = frames_of(record(scene, NumberFormats{}).trace).back();
      for (const std::string_view program : {"normal", "plane", "facing"}) {
        if (program == "facing" && side < 0) continue;  // draws nothing from behind
        scene.splatting.ewa_program = program;
        const splatscope::Frame frame = frames_of(record(scene, NumberFormats{}).trace).back();
        EXPECT_GT(psnr(frame, paper), 35) << program << ", turn " << turn << ", side " << side;
      }
    }
  }
}

// The three short programs draw what the paper's does.
void expect_same_by_every_program(Scene scene) {
  const splatscope::Frame paper = frames_of(record(scene, NumberFormats{}).trace).back();
  for (const std::string_view program : {"normal", "plane", "facing"}) {
    scene.splatting.ewa_program = program;
    EXPECT_GT(psnr(frames_of(record(scene, NumberFormats{}).trace).back(), paper), 40) << program;
  }
}

// Culling goes by how a quad winds: the front of a model is what every program leaves.
TEST(Recorder, DrawsAModelByEveryProgram) {
  const Scene scene = parse_scene(
      "[surfels]\ngenerator = \"sphere\"\ncount = 2000\n[frame]\nwidth = 64\nheight = 64\n"
      "[splatting]\nalgorithm = \"ewa-per-surfel\"\n[capture]\nviews = 8\nframe_size = 128\n",
      "sphere.toml");
  ASSERT_EQ(Faces::front, scene.splatting.faces);
  expect_same_by_every_program(scene);
}

// Their depth has a part that grows with the near plane's distance: it must not reach z_t.
TEST(Recorder, DrawsFromAfarByEveryProgram) {
  expect_same_by_every_program(
      parse_scene("[surfels]\ncolumns = 64\nrows = 64\n[camera]\neye = [0, 700, 1980]\ntarget = [0, 0, 0]\n"
                  "fov_y_degrees = 2\nnear = 1500\nfar = 3000\n[frame]\nwidth = 64\nheight = 64\n"
                  "[splatting]\nalgorithm = \"ewa-per-pixel\"\n",
                  "far.toml"));
}

// A scene in another unit of length is the same picture, also where the programs of fewer slots would lose
// the depth in what floats lose of 1 - 1/near. The paper's needs no unit of its own.
TEST(Recorder, TheUnitOfLengthChangesNothing) {
  const auto picture_in = [](double unit, const kernels::SplatProgram& program) {
    Scene scene = small_plane(Algorithm::ewa_per_pixel);
    scene.splatting.ewa_program = program.name;
    scene.splatting.depth_offset *= unit;
    for (Surfel& surfel : scene.surfels) {
      surfel.position *= static_cast<float>(unit);
      surfel.radius *= static_cast<float>(unit);
    }
    for (double* length : {&scene.camera.near, &scene.camera.far}) *length *= unit;
    for (glm::dvec3* place : {&scene.camera.eye, &scene.camera.target}) *place *= unit;
    return render(record(scene, NumberFormats{}).trace, {}).frame;
  };
  for (const kernels::SplatProgram& program : kernels::ewa_programs()) {
    SCOPED_TRACE(program.name);
    const splatscope::Frame frame = picture_in(1, program);
    for (const double unit : {0x1p10, 0x1p20, 0x1p40}) EXPECT_EQ(frame, picture_in(unit, program)) << unit;
  }
}

// A surfel is too large by its pixels, not by what the near plane would make of it.
TEST(Recorder, ANearPlaneNextToTheEyeMakesNoSurfelSmaller) {
  Scene scene = parse_scene(
      "[surfels]\ncolumns = 32\nrows = 32\n[camera]\neye = [0, 100, 100]\ntarget = [0, 0, 0]\n"
      "fov_y_degrees = 2\nfar = 1000\nnear = 10\n[frame]\nwidth = 64\nheight = 64\n"
      "[splatting]\nalgorithm = \"ewa-per-pixel\"\n",
      "near.toml");
  const NumberFormats formats{.depth = DepthFormat::float32};
  const splatscope::Frame usual = frames_of(record(scene, formats).trace).back();
  scene.camera.near = 1e-6;
  EXPECT_GT(psnr(frames_of(record(scene, formats).trace).back(), usual), 40);
}

TEST(Recorder, HostileSurfelsLeaveNoNaN) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), huge = 1e38f;
  Scene scene = small_plane(Algorithm::ewa_per_pixel);
  for (const glm::vec3 position : {glm::vec3(nan, 0, 0), glm::vec3(huge, huge, huge), glm::vec3(0, 14, -20),
                                   glm::vec3(0, 15, -21), glm::vec3(0, 13.9f, -19.8f)}) {
    Surfel surfel = scene.surfels.front();
    surfel.position = position;
    scene.surfels.push_back(surfel);
  }
  for (const FrameFormat format : {FrameFormat::unorm8, FrameFormat::float32}) {
    RenderOptions options;
    options.formats.frame = format;
    options.formats.color = format == FrameFormat::unorm8 ? ColorFormat::unorm8 : ColorFormat::float32;
    const Rendered rendered = render(record(scene, options.formats).trace, options);
    for (std::size_t pixel = 0; pixel < 64 * 64; ++pixel) {
      for (const float channel : rendered.frame.color(pixel)) ASSERT_TRUE(std::isfinite(channel)) << pixel;
    }
    EXPECT_GT(rendered.counters.triangles_not_finite, 0u);
    EXPECT_GT(rendered.counters.triangles_behind, 0u);
  }
}

// Each level has weights to capture.
TEST(Recorder, ProgressRunsOnceOverAllLevels) {
  Scene scene = small_plane(Algorithm::ewa_per_surfel);
  scene.capture.views = 4;
  scene.capture.frame_size = 32;
  scene.hierarchy = {.culling = Culling::off, .block_surfels = 16, .progressive = true};
  std::vector<double> told;
  record(scene, NumberFormats{}, [&](double fraction) { told.push_back(fraction); });
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_LT(told.front(), 0.5);
  EXPECT_DOUBLE_EQ(told.back(), 1);
}

// Coarse surfels overlap more than fine ones: each level has a gamma by which no more than a hundredth of its
// sums passes 1. What the host does not divide shows them.
TEST(Recorder, NoLevelSaturates) {
  const Scene scene = parse_scene(
      "surfels = { generator = \"sphere\", count = 3000 }\nframe = { width = 128, height = 128 }\n"
      "splatting.algorithm = \"ewa-per-pixel\"\nhierarchy = { progressive = true, block_surfels = 16 }\n",
      "sphere.toml");
  RenderOptions options;
  options.formats.frame = FrameFormat::float32;
  options.formats.color = ColorFormat::float32;
  Trace trace = record(scene, options.formats).trace;
  std::erase_if(trace.commands, [](const Command& c) { return std::holds_alternative<NormalizeOnHost>(c); });
  std::size_t frames = 0;
  render(trace, options, {}, [&](const splatscope::Frame& frame) {
    std::size_t drawn = 0, saturated = 0;
    for (std::size_t pixel = 0; pixel < frame.depth.size(); ++pixel) {
      drawn += frame.color(pixel)[3] > 0;
      saturated += frame.color(pixel)[3] > 1;
    }
    EXPECT_GT(drawn, 5000u);
    EXPECT_LE(saturated, drawn / 100) << "frame " << frames;
    ++frames;
  });
  EXPECT_EQ(frames, 4u);
}

}  // namespace
}  // namespace splatscope::traces
