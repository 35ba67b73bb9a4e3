#include "kernels/object_space_ewa/programs.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "kernels/object_space_ewa/quad_runner.h"
#include "kernels/short_ewa/programs.h"
#include "model/error.h"
#include "model/testing/random_seed.h"

namespace splatscope::kernels {
namespace {

constexpr double kDepthOffset = 0.05;

// Surfels of every kind that some instruction is there for.
std::vector<Surfel> mixed_surfels(const View& view, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<Surfel> surfels = random_surfels(view, SurfelRanges{}, 500, generator);
  const glm::dmat4 to_object = glm::inverse(view.object_to_camera);
  const auto add = [&](const glm::dvec3& o, const glm::dvec3& s, const glm::dvec3& t) {  // camera space
    Surfel surfel;
    surfel.position = glm::dvec3(to_object * glm::dvec4(o, 1.0));
    surfel.tangent_s = glm::dmat3(to_object) * s;
    surfel.tangent_t = glm::dmat3(to_object) * t;
    surfel.sigma = 0.8;
    surfels.push_back(surfel);
  };
  add({0, 0, 2}, {0.01, 0, 0}, {0, 0.01, 0});                         // faces the camera: t = 0
  add({0, 0, 2}, {0.0075, 0.0025, -0.006}, {0.0025, 0.0075, 0.006});  // p = 0
  add({0, 0, 2}, {0.01, 0, 0}, {0, 0, 0.01});                         // edge-on: D = 0
  add({0.3, 0.1, -2}, {0.01, 0, 0}, {0, 0.01, 0});                    // behind the eye
  SurfelRanges huge{.cosine = {1e-7, 1e-3},
                    .spacing = {1e4, 1e6}};  // edge-on: rounding makes a variance negative
  for (int i = 0; i < 500; ++i) surfels.push_back(random_surfel(view, huge, generator));
  return surfels;
}

// The distance is that of the normal as it stands in the vertex, rounded to float: not of the exact one.
TEST(Programs, ThePlaneInAVertexBelongsToTheNormalBesideIt) {
  const View view = test_view();
  for (const Surfel& surfel : mixed_surfels(view, random_seed())) {
    const std::span<const VertexField> fields = ewa_program("facing").fields;
    std::vector<std::byte> vertex(vertex_bytes(fields));
    write_vertex(fields, {surfel, {0, 0}, 1}, vertex.data());
    std::array<float, 7> written;  // o, n, -n.o
    std::memcpy(written.data(), vertex.data(), sizeof written);
    const glm::dvec3 n(written[3], written[4], written[5]);
    ASSERT_EQ(static_cast<float>(-glm::dot(n, surfel.position)), written[6]);
  }
}

TEST(Programs, SlotsOfThePaper) {
  EXPECT_EQ(isa::slot_count(load_program(kVisibilityProgram)), 13);
  EXPECT_EQ(isa::slot_count(load_program(kPlainProgram)), 21);
  EXPECT_EQ(isa::slot_count(load_program(kEwaProgram)), 78);
}

TEST(Programs, SlotsOfTheShortOnes) {
  EXPECT_EQ(isa::slot_count(load_program(kCornerVisibilityProgram)), 9);
  EXPECT_EQ(isa::slot_count(load_program(kNormalProgram)), 37);
  EXPECT_EQ(isa::slot_count(load_program(kPlaneProgram)), 31);
  EXPECT_EQ(isa::slot_count(load_program(kFacingProgram)), 29);
}

TEST(Programs, AnUnknownNameIsAnError) {
  EXPECT_THROW(shader_text("splat.vs"), ModelError);
  EXPECT_THROW(ewa_program("quad"), ModelError);
  EXPECT_THROW(visibility_program("paper"), ModelError);
}

std::vector<SplatProgram> all_programs() {
  std::vector<SplatProgram> programs{plain_program()};
  programs.insert(programs.end(), visibility_programs().begin(), visibility_programs().end());
  programs.insert(programs.end(), ewa_programs().begin(), ewa_programs().end());
  return programs;
}

class Liveness : public testing::TestWithParam<SplatProgram> {};

// Without any one instruction some surfel comes out otherwise: nothing is padding.
TEST_P(Liveness, EveryInstructionChangesAnOutput) {
  const View view = rounded(look_at({0, 0, -4}, {0, 0, 0}, {0, 1, 0}, 60.0, 512, 400, 0.1, 1000.0));
  const std::vector<Surfel> surfels = mixed_surfels(view, 78);
  const std::vector<Vec4> constants = GetParam().constants(view, kCutoff, kDepthOffset);
  const isa::Program program = load_program(GetParam().file);
  const auto run = [&](const isa::Program& changed) {
    return run_quads(changed, GetParam().fields, Arithmetic::ieee, constants, surfels);
  };
  const auto whole = run(program);
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    isa::Program without = program;
    without.instructions.erase(without.instructions.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(run(without), whole) << program.name << ":" << program.instructions[i].line << " is dead";
  }
}
INSTANTIATE_TEST_SUITE_P(Programs, Liveness, testing::ValuesIn(all_programs()), program_name);

// The frustum of splat_constants: clip coordinates over w are window coordinates and depth.
TEST(Programs, ProjectionIsThatOfTheView) {
  const View view = rounded(look_at({1, 2, -4}, {0, 0, 0}, {0, 1, 0}, 50.0, 640, 480, 0.5, 20.0));
  std::vector<Surfel> surfels(1);
  surfels[0].position = glm::vec3(0.5, 0.25, 0.125);
  for (const double depth : {0.5, 3.0, 20.0}) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.2, 0.3, 1.0));
    const glm::dvec3 o = direction * (depth / direction.z);
    surfels[0].position = glm::dvec3(glm::inverse(view.object_to_camera) * glm::dvec4(o, 1.0));
    const auto quads = run_quads(plain_program(), Arithmetic::ieee, view, 0.0, surfels);
    const glm::dvec4 clip(quads[0][0].position);  // no tangents: every corner is o
    const glm::dvec2 window = view.window(o);
    EXPECT_NEAR(view.center().x + 0.5 * view.width * clip.x / clip.w, window.x, 1e-3);
    EXPECT_NEAR(view.center().y - 0.5 * view.height * clip.y / clip.w, window.y, 1e-3);
    EXPECT_NEAR(clip.w, depth, 1e-5);
    EXPECT_NEAR(clip.z / clip.w, (depth - 0.5) / (20.0 - 0.5) * 20.0 / depth, 1e-5);
  }
}

// Section 5.1: o +- s +- t, each moved by z_t along its own viewing ray.
TEST(Programs, VisibilityMovesCornersAlongTheirViewingRays) {
  const View view = test_view();
  std::mt19937 generator(13);
  SurfelRanges ranges;
  ranges.depth[1] = 10.0;
  const std::vector<Surfel> surfels = random_surfels(view, ranges, 1000, generator);
  for (const SplatProgram& program : visibility_programs()) {
    const auto quads = run_quads(program, Arithmetic::ieee, view, kDepthOffset, surfels);
    for (std::size_t i = 0; i < surfels.size(); ++i) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const glm::dvec2 y = 2.0 * kQuadCorners[corner] - 1.0;
        const glm::dvec3 p =
            view.camera_space(surfels[i].position + y.x * surfels[i].tangent_s + y.y * surfels[i].tangent_t);
        const glm::dvec3 moved = p + kDepthOffset * glm::normalize(p);
        const glm::dvec4 clip(quads[i][corner].position);
        const double tolerance = 1e-6 * (glm::length(p) + 5.0);  // 5: the eye's distance from the origin
        EXPECT_NEAR(clip.w, moved.z, tolerance);
        EXPECT_NEAR(clip.x * 0.5 * view.width / view.eta, moved.x, tolerance);
        EXPECT_NEAR(clip.y * 0.5 * view.height / view.eta, moved.y, tolerance);
      }
    }
  }
}

TEST(Programs, ColourAndTextureCoordinatesPass) {
  const View view = test_view();
  std::mt19937 generator(5);
  const std::vector<Surfel> surfels{random_surfel(view, SurfelRanges{}, generator)};
  std::vector<SplatProgram> programs{plain_program()};
  programs.insert(programs.end(), ewa_programs().begin(), ewa_programs().end());
  for (const SplatProgram& program : programs) {
    const auto quads = run_quads(program, Arithmetic::ieee, view, 0.0, surfels);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      EXPECT_EQ(quads[0][corner].texture, glm::vec2(kQuadCorners[corner]));
      EXPECT_EQ(glm::vec3(quads[0][corner].diffuse), glm::vec3(surfels[0].color));
    }
  }
}

}  // namespace
}  // namespace splatscope::kernels
