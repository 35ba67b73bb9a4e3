#include "traces/volume_trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <set>
#include <string>

#include "kernels/reference/volume/procedural.h"
#include "kernels/voxel_ewa/programs.h"
#include "model/render.h"
#include "model/stop.h"
#include "traces/trace_file.h"

namespace splatscope::traces {
namespace {

using kernels::VolumeSplats;

// Shells of two opacities; flat kernels where the value is high.
VolumeSplats shells(int n, bool flat, double s = 1e4) {
  const glm::dvec3 blue{0.2, 0.4, 0.9}, gold{0.9, 0.7, 0.2};
  const kernels::TransferFunction transfer(
      {{0.2, {0, blue}}, {0.4, {0.2, blue}}, {0.7, {0.2, blue}}, {0.75, {0.45, gold}}, {1, {0.45, gold}}});
  return kernels::grid_splats(kernels::concentric_shells(n, 3), transfer, 1,
                              flat ? kernels::Flattening{0.72, 1.0, s} : kernels::Flattening{});
}

kernels::View view_of_shells(int size) {
  return kernels::look_at({1.5, -2.2, 3.4}, {0, 0, 0}, {0, 1, 0}, 30, size, size, 1, 10);
}

NumberFormats exact_formats() {
  NumberFormats formats;
  formats.frame = FrameFormat::float32;
  formats.color = ColorFormat::float32;
  formats.subpixel_bits = 8;
  return formats;
}

constexpr VolumeTraceSettings kExact{.texture_length = 2048, .texture_bits = 16, .float_colors = true};

// dB of r, g and b against the reference's, over the pixels that the volume covers.
double psnr(const Frame& frame, const kernels::VolumePicture& reference) {
  double squares = 0, samples = 0;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    if (reference.pixels[i].w < 0.5 / 255) continue;
    samples += 3;
    const Vec4 color = frame.color(i);
    for (std::size_t c = 0; c < 3; ++c) {
      const double difference = static_cast<double>(color[c]) - reference.pixels[i][static_cast<int>(c)];
      squares += difference * difference;
    }
  }
  return -10 * std::log10(squares / samples);
}

Frame drawn(const Trace& trace, const NumberFormats& formats) {
  RenderOptions options;
  options.formats = formats;
  options.record = Record::nothing;
  return render(trace, options).frame;
}

TEST(VolumeTrace, StopsWhereItIsAskedTo) {
  const VolumeSplats splats = shells(8, false);
  stop_signal = SIGINT;
  EXPECT_THROW(volume_trace(view_of_shells(32), splats, {}), Interrupted);
  stop_signal = 0;
}

TEST(VolumeTrace, PictureIsThatOfTheSoftwareWithTheSameSheets) {
  const kernels::View view = view_of_shells(128);
  for (const double s : {1.0, 1.5, 1e4}) {  // of flat kernels; 1: none is
    const bool flat = s > 1;
    const VolumeSplats splats = shells(40, flat, s);
    const kernels::VolumePicture reference =
        kernels::volume_picture(view, splats, {.cutoff = kExact.cutoff, .light = kExact.light});
    const VolumeTrace exact = volume_trace(view, splats, kExact);
    EXPECT_EQ(exact.splats + exact.left_out, splats.splats.size());
    EXPECT_EQ(exact.flat > 0, flat);
    const double in_float = psnr(drawn(exact.trace, exact_formats()), reference);
    NumberFormats combiners;
    combiners.combiner = CombinerFormat::signed9;
    const double in_8_bits = psnr(drawn(volume_trace(view, splats, {}).trace, combiners), reference);
    std::printf("s = %g: %.1f dB in float, %.1f dB in 8 bits\n", s, in_float, in_8_bits);
    EXPECT_GT(in_float, 50);
    EXPECT_GT(in_8_bits, 37);  // half of what is left are steps that fall one way or the other: 3 dB
  }
}

// The general program draws what the one for grids does.
TEST(VolumeTrace, BothProgramsDrawTheSame) {
  const kernels::View view = view_of_shells(96);
  const VolumeSplats splats = shells(24, false);
  VolumeTraceSettings settings = kExact;
  const VolumeTrace shared = volume_trace(view, splats, settings);
  settings.shared_variance = false;
  const VolumeTrace own = volume_trace(view, splats, settings);
  EXPECT_EQ(shared.flat, 0u);
  EXPECT_EQ(own.flat, 0u);
  EXPECT_GT(own.vertex_bytes, 2 * shared.vertex_bytes);
  // Four vertices of 12 + 16 bytes a splat, which are written anew each frame, and of 20 a sheet.
  EXPECT_EQ(shared.vertex_bytes, 4 * (28 * shared.splats + 20 * shared.sheets));
  for (const Command& command : shared.trace.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (!draw) continue;
    EXPECT_EQ(shared.trace.buffers[draw->vertex_buffer].place == MemoryPlace::agp, draw->texture.has_value());
  }
  const Frame a = drawn(shared.trace, exact_formats()), b = drawn(own.trace, exact_formats());
  for (std::size_t i = 0; i < 96 * 96; ++i) {
    // A fragment at a splat's edge may fall to one side or the other: exp(-2) of a splat of 0.05.
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(a.color(i)[c], b.color(i)[c], 0.05 * std::exp(-2.0)) << i;
  }
}

// A draw has the pixel program with the fewest steps that hold its largest contribution: where that fills the
// sheet to 0.96 all 255, as the next has 181, and where it is less than 0.7 fewer.
TEST(VolumeTrace, FaintDrawsHaveStepsOfTheirOwn) {
  const VolumeTrace recorded = volume_trace(view_of_shells(96), shells(24, false), {});
  std::set<std::string> programs;
  for (const Command& command : recorded.trace.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw && draw->texture) programs.insert(recorded.trace.programs[*draw->pixel_program].text);
  }
  EXPECT_TRUE(programs.contains(kernels::voxel_pixel_program(255).text));
  EXPECT_GT(programs.size(), 2u);
}

// What a file holds is what is drawn; it keeps every rule of trace files.
TEST(VolumeTrace, IsATraceFile) {
  const VolumeTrace recorded = volume_trace(view_of_shells(64), shells(16, true), {});
  EXPECT_NO_THROW(check_trace(recorded.trace, "volume"));
  EXPECT_EQ(recorded.trace.surfaces, 1u);
  EXPECT_GT(recorded.sheets, 10u);
}

TEST(VolumeTrace, AVolumeOutOfSightIsAClearFrame) {
  const kernels::View view = kernels::look_at({0, 0, 5}, {0, 0, 10}, {0, 1, 0}, 30, 32, 32, 1, 10);
  const VolumeTrace recorded = volume_trace(view, shells(8, false), {});
  EXPECT_EQ(recorded.splats, 0u);
  EXPECT_NO_THROW(check_trace(recorded.trace, "volume"));
  const Frame frame = drawn(recorded.trace, {});
  for (std::size_t i = 0; i < 32 * 32; ++i) EXPECT_EQ(frame.color(i)[3], 0);
}

}  // namespace
}  // namespace splatscope::traces
