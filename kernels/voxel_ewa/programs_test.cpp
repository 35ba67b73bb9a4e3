#include "kernels/voxel_ewa/programs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>
#include <span>
#include <vector>

#include "kernels/object_space_ewa/programs.h"
#include "kernels/reference/volume/footprint.h"
#include "model/isa/program.h"
#include "model/vertex/vertex_program.h"

// The voxel programs against the double-precision footprints.
namespace splatscope::kernels {
namespace {

constexpr double kCutoff = 4;
constexpr double kUnit = 0.25;

struct Voxel {
  glm::dvec3 position{};
  glm::dmat3 variance{1.0};
};

using Corners = std::array<glm::dvec4, 4>;  // oPos
struct VoxelOutput {
  Corners corners;
  std::array<glm::dvec4, 4> diffuse;
  std::array<glm::dvec2, 4> texture;
  bool operator==(const VoxelOutput&) const = default;
};

constexpr glm::dvec2 kCorners[4] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
const glm::dvec4 kColor{0.25, 0.5, 0.75, 0.8};

std::vector<VoxelOutput> run(const isa::Program& program, Arithmetic arithmetic,
                             std::span<const Vec4> constants, std::span<const Voxel> voxels) {
  const vertex::VertexProgram executable(program, arithmetic);
  std::vector<VoxelOutput> outputs(voxels.size());
  vertex::InputBatch in{};
  vertex::OutputBatch out{};
  for (std::size_t k = 0; k < voxels.size(); ++k) {
    const auto set = [&](int input, std::size_t corner, const glm::dvec4& value) {
      for (int c = 0; c < 4; ++c) in.v[input][c][corner] = static_cast<float>(value[c]);
    };
    for (std::size_t i = 0; i < 4; ++i) {
      set(kVoxelPositionInput, i, glm::dvec4(voxels[k].position, 1));
      set(kVoxelCornerInput, i, {kCorners[i], 0, 1});
      set(kVoxelColorInput, i, kColor);
      for (int row = 0; row < 3; ++row)
        set(kVoxelVarianceInput + row, i, glm::dvec4(voxels[k].variance[row], 1));
    }
    executable.run(constants, in, out, 4);
    for (std::size_t i = 0; i < 4; ++i) {
      for (int c = 0; c < 4; ++c) {
        outputs[k].corners[i][c] = out.o[vertex::oPos][c][i];
        outputs[k].diffuse[i][c] = out.o[vertex::oD0][c][i];
      }
      outputs[k].texture[i] = {out.o[vertex::oT0][0][i], out.o[vertex::oT0][1][i]};
    }
  }
  return outputs;
}

View test_view() {
  View view = look_at({0.3, -0.2, -4.0}, {0.1, 0.4, 1.0}, {0.1, 1.0, 0.05}, 60.0, 512, 400, 0.1, 1000.0);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row)
      view.object_to_camera[column][row] = static_cast<float>(view.object_to_camera[column][row]);
  }
  return view;
}

glm::dmat3 rotation(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  const auto direction = [&] { return glm::dvec3(normal(generator), normal(generator), normal(generator)); };
  const glm::dvec3 a = glm::normalize(direction()), b = glm::normalize(glm::cross(a, direction()));
  return {a, b, glm::cross(a, b)};
}

// A kernel of random axes; each between `low` and `high` pixels where it stands.
Voxel random_voxel(const View& view, double low, double high, std::mt19937& generator) {
  const auto log_uniform = [&](double from, double to) {
    return std::exp(std::uniform_real_distribution(std::log(from), std::log(to))(generator));
  };
  std::uniform_real_distribution<double> half(-0.5, 0.5);
  const double z = log_uniform(1, 100);
  const glm::dvec3 camera =
      z * glm::dvec3(half(generator) * view.width / view.eta, half(generator) * view.height / view.eta, 1);
  Voxel voxel;
  voxel.position = glm::vec3(glm::dvec3(glm::inverse(view.object_to_camera) * glm::dvec4(camera, 1)));
  const glm::dmat3 turn = rotation(generator);
  glm::dmat3 axes = turn;
  for (int i = 0; i < 3; ++i) axes[i] *= log_uniform(low, high) * z / view.eta;
  voxel.variance = axes * glm::transpose(axes);
  for (int i = 0; i < 3; ++i) voxel.variance[i] = glm::vec3(voxel.variance[i]);
  return voxel;
}

struct Errors {
  double deviation = 0;  // relative, of the standard deviation in every direction of the screen
  double center = 0;     // pixels
  double peak = 0;       // relative
};

// The quad's half diagonals give L: corner = centre + L r y.
void compare(const View& view, const Voxel& voxel, const VoxelOutput& output, Errors& errors) {
  const auto exact = footprint(view, Projection::perspective, VolumePrefilter::ewa,
                               view.camera_space(voxel.position), camera_variance(view, voxel.variance));
  ASSERT_TRUE(exact);
  std::array<glm::dvec2, 4> at;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec4& clip = output.corners[i];
    at[i] = view.center() + glm::dvec2(0.5 * view.width * clip.x, -0.5 * view.height * clip.y) / clip.w;
  }
  const glm::dmat2 factor{(at[1] - at[0] + at[2] - at[3]) / (4 * std::sqrt(kCutoff)),
                          (at[3] - at[0] + at[2] - at[1]) / (4 * std::sqrt(kCutoff))};
  // L^T Q L would be I: its eigenvalues are squared ratios of standard deviations.
  const glm::dmat2 ratio = glm::transpose(factor) * exact->conic * factor;
  const double mean = 0.5 * (ratio[0][0] + ratio[1][1]);
  const double spread = std::hypot(0.5 * (ratio[0][0] - ratio[1][1]), ratio[0][1]);
  errors.deviation = std::max({errors.deviation, std::sqrt(mean + spread) - 1, 1 - std::sqrt(mean - spread)});
  errors.center =
      std::max(errors.center, glm::distance(0.25 * (at[0] + at[1] + at[2] + at[3]), exact->center));
  errors.peak = std::max(errors.peak, std::abs(output.diffuse[0].w / (kColor.w * kUnit * exact->peak) - 1));
}

Errors errors_of(std::string_view file, Arithmetic arithmetic, double low, double high) {
  constexpr std::uint32_t kSeed = 2002;
  const View view = test_view();
  std::mt19937 generator(kSeed);
  const isa::Program program = load_program(file);
  Errors errors;
  for (int i = 0; i < 2000; ++i) {
    const std::array voxels{random_voxel(view, low, high, generator)};
    const bool shared = file == kVoxelGridProgram;
    const std::vector<Vec4> constants =
        voxel_constants(view, glm::dmat4(1.0), shared ? &voxels[0].variance : nullptr, kCutoff, kUnit);
    compare(view, voxels[0], run(program, arithmetic, constants, voxels)[0], errors);
  }
  std::printf(
      "%s, seed %u, axes of %g to %g pixels: standard deviation off by %.2e, centre by %.2e pixels, "
      "peak by %.2e\n",
      std::string(file).c_str(), kSeed, low, high, errors.deviation, errors.center, errors.peak);
  return errors;
}

TEST(VoxelPrograms, Slots) {
  EXPECT_EQ(isa::slot_count(load_program(kVoxelGridProgram)), 28);
  EXPECT_EQ(isa::slot_count(load_program(kVoxelProgram)), 39);
  EXPECT_EQ(isa::slot_count(load_program(kSheetProgram)), 3);
}

class VoxelAccuracy : public testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(Programs, VoxelAccuracy, testing::Values(kVoxelGridProgram, kVoxelProgram),
                         [](const auto& info) { return info.param == kVoxelProgram ? "own" : "shared"; });

// Three times what was measured. A pixel's share of 512 in binary32 is 3e-5; the second pivot is 1/100 of
// what it is the difference of, and for flat kernels of 50 pixels 1/2500.
TEST_P(VoxelAccuracy, VoxelsOfAVolume) {
  for (const Arithmetic arithmetic : {Arithmetic::ieee, Arithmetic::nv20}) {
    const Errors errors = errors_of(GetParam(), arithmetic, 0.05, 10);
    EXPECT_LT(errors.deviation, 2e-5);
    EXPECT_LT(errors.center, 3e-4);
    EXPECT_LT(errors.peak, 2e-5);
  }
}

TEST_P(VoxelAccuracy, FlatAndLongKernels) {
  const Errors errors = errors_of(GetParam(), Arithmetic::ieee, 0.005, 50);
  EXPECT_LT(errors.deviation, 3e-4);
  EXPECT_LT(errors.peak, 3e-4);
}

// Without any one instruction some voxel comes out otherwise: nothing is padding.
TEST_P(VoxelAccuracy, EveryInstructionChangesAnOutput) {
  const View view = test_view();
  std::mt19937 generator(7);
  std::vector<Voxel> voxels;
  for (int i = 0; i < 20; ++i) voxels.push_back(random_voxel(view, 0.2, 5, generator));
  const std::vector<Vec4> constants = voxel_constants(
      view, glm::dmat4(1.0), GetParam() == kVoxelGridProgram ? &voxels[0].variance : nullptr, kCutoff, kUnit);
  const isa::Program program = load_program(GetParam());
  const auto whole = run(program, Arithmetic::ieee, constants, voxels);
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    isa::Program without = program;
    without.instructions.erase(without.instructions.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(run(without, Arithmetic::ieee, constants, voxels), whole)
        << GetParam() << ":" << program.instructions[i].line << " is dead";
  }
}

TEST_P(VoxelAccuracy, DepthColourAndTextureCoordinates) {
  const View view = test_view();
  std::mt19937 generator(11);
  const std::array voxels{random_voxel(view, 0.2, 5, generator)};
  const std::vector<Vec4> constants =
      voxel_constants(view, glm::dmat4(1.0), &voxels[0].variance, kCutoff, kUnit);
  const VoxelOutput output =
      run(load_program(GetParam()), Arithmetic::ieee,
          GetParam() == kVoxelGridProgram ? constants
                                          : voxel_constants(view, glm::dmat4(1.0), nullptr, kCutoff, kUnit),
          voxels)[0];
  const double z = view.camera_space(voxels[0].position).z;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(output.corners[i].w, z, 1e-5 * z);
    const double depth = view.far_plane * (z - view.near_plane) / ((view.far_plane - view.near_plane) * z);
    EXPECT_NEAR(output.corners[i].z / output.corners[i].w, depth, 1e-6);
    EXPECT_EQ(output.texture[i], 0.5 * (kCorners[i] + 1.0));
    EXPECT_EQ(glm::dvec3(output.diffuse[i]), glm::dvec3(kColor));
  }
}

// A vertex buffer of grid indices: the matrix from them to object space goes into the constants.
TEST(VoxelPrograms, PositionsInUnitsOfTheGrid) {
  const View view = test_view();
  const glm::dmat4 to_object(0.01, 0, 0, 0, 0, 0.02, 0, 0, 0, 0, 0.03, 0, 0.5, -0.25, 0.125, 1);
  const Voxel on_grid{{17, -5, 9}, glm::dmat3(1e-4, 0, 0, 0, 4e-4, 0, 0, 0, 9e-4)};
  const Voxel in_object{glm::dvec3(to_object * glm::dvec4(on_grid.position, 1)), on_grid.variance};
  const auto outputs =
      run(load_program(kVoxelGridProgram), Arithmetic::ieee,
          voxel_constants(view, to_object, &on_grid.variance, kCutoff, kUnit), std::array{on_grid});
  Errors errors;
  compare(view, in_object, outputs[0], errors);
  EXPECT_LT(errors.center, 1e-3);
  EXPECT_LT(errors.deviation, 1e-5);
  EXPECT_LT(errors.peak, 1e-5);
}

TEST(VoxelPrograms, PixelProgramsLoad) {
  for (const int steps : {255, 32, 1}) {
    const ShaderText text = voxel_pixel_program(steps);
    EXPECT_EQ(isa::slot_count(splatscope::load_program(text)), 4);
  }
  EXPECT_EQ(isa::slot_count(load_program(kSheetPixelProgram)), 2);
}

}  // namespace
}  // namespace splatscope::kernels
