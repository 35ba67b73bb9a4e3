#include "traces/point_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "model/error.h"
#include "model/testing/append_bytes.h"
#include "model/testing/random_seed.h"
#include "model/testing/scratch_folder.h"
#include "traces/output_files.h"

namespace splatscope::traces {
namespace {

namespace fs = std::filesystem;

class PointFileTest : public testing::Test {
 protected:
  PointFile read(std::string_view text) {
    write_file(ply_, text);
    return read_ply(ply_);
  }
  std::string error_of(std::string_view text) {
    const std::string error = folder_.error_of([&] { read(text); });
    return error.starts_with("p.ply") ? error.substr(5) : error;
  }
  Scene scene_of(std::string_view text, std::string_view keys = "") {
    write_file(ply_, text);
    return parse_scene(fmt::format("[surfels]\nfile = \"p.ply\"\n{}", keys), folder_ / "s.toml");
  }

  ScratchFolder folder_;
  fs::path ply_ = folder_ / "p.ply";
};

// Properties out of order, unknown ones and lists between them, another element before.
std::string binary_file(bool big_endian) {
  std::string bytes = fmt::format(
      "ply\r\nformat binary_{}_endian 1.0\r\ncomment made here\nelement other 2\nproperty list uchar short "
      "a\n"
      "element vertex 2\nproperty double z\nproperty uchar blue\nproperty uchar red\nproperty uchar green\n"
      "property list ushort int extra\nproperty float x\nproperty float y\nproperty float nz\nproperty float "
      "ny\n"
      "property short nx\nproperty float radius\nend_header\n",
      big_endian ? "big" : "little");
  for (int items : {2, 0}) {
    append_bytes(bytes, static_cast<std::uint8_t>(items), big_endian);
    for (int i = 0; i < items; ++i) append_bytes(bytes, std::int16_t{-5}, big_endian);
  }
  for (int i = 0; i < 2; ++i) {
    append_bytes(bytes, 3.5 + i, big_endian);
    for (int c : {0, 255, 51}) append_bytes(bytes, static_cast<std::uint8_t>(c), big_endian);
    append_bytes(bytes, std::uint16_t{1}, big_endian);
    append_bytes(bytes, std::int32_t{77}, big_endian);
    append_bytes(bytes, 1.25f, big_endian);
    append_bytes(bytes, -2.0f, big_endian);
    append_bytes(bytes, 0.0f, big_endian);
    append_bytes(bytes, 0.5f, big_endian);
    append_bytes(bytes, std::int16_t{-1}, big_endian);
    append_bytes(bytes, 0.75f, big_endian);
  }
  return bytes;
}

TEST_F(PointFileTest, BinaryOfBothByteOrders) {
  for (bool big_endian : {false, true}) {
    const PointFile points = read(binary_file(big_endian));
    EXPECT_TRUE(points.has_normals);
    EXPECT_TRUE(points.has_radii);
    ASSERT_EQ(points.surfels.size(), 2u);
    for (int i = 0; i < 2; ++i) {
      const Surfel& s = points.surfels[static_cast<std::size_t>(i)];
      EXPECT_EQ(s.position, glm::vec3(1.25, -2, 3.5 + i));
      EXPECT_EQ(s.normal, glm::vec3(-1, 0.5, 0));
      EXPECT_EQ(s.radius, 0.75f);
      EXPECT_EQ(s.color, glm::vec3(1, 0.2f, 0));
    }
  }
}

TEST_F(PointFileTest, BinaryOfEachWholeType) {
  on_each_whole_type([&](std::string_view type, std::string_view other, auto least, auto most) {
    for (const bool big_endian : {false, true}) {
      std::string bytes = fmt::format(
          "ply\nformat binary_{0}_endian 1.0\nelement vertex 1\nproperty {1} x\nproperty {2} y\n"
          "property float z\nend_header\n",
          big_endian ? "big" : "little", type, other);
      append_bytes(bytes, least, big_endian);
      append_bytes(bytes, most, big_endian);
      append_bytes(bytes, 0.5f, big_endian);
      const PointFile points = read(bytes);
      ASSERT_EQ(points.surfels.size(), 1u) << type;
      EXPECT_EQ(points.surfels[0].position, glm::vec3(least, most, 0.5f)) << type;
    }
  });
}

TEST_F(PointFileTest, EveryTruncationOfBinaryIsRefused) {
  const std::string whole = binary_file(false);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(error_of(whole.substr(0, size)), "no error") << size << " bytes of " << whole.size();
}

constexpr std::string_view kAscii =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "property float red\nproperty float green\nproperty float blue\nend_header\n"
    "0 0 +1e1 0.5 0 1\n1 nan 0 2 -1 0\n\n 2 0 0 1 1 1";

TEST_F(PointFileTest, Ascii) {
  const PointFile points = read(kAscii);
  EXPECT_FALSE(points.has_normals);
  EXPECT_FALSE(points.has_radii);
  ASSERT_EQ(points.surfels.size(), 3u);
  EXPECT_EQ(points.surfels[0].position, glm::vec3(0, 0, 10));
  EXPECT_EQ(points.surfels[0].color, glm::vec3(0.5, 0, 1));
  EXPECT_TRUE(std::isnan(points.surfels[1].position.y));
  EXPECT_EQ(points.surfels[2].position, glm::vec3(2, 0, 0));
}

TEST_F(PointFileTest, AByteOrderMarkIsPassedOver) {
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(read(mark + std::string(kAscii)).surfels.at(2).position, glm::vec3(2, 0, 0));
  EXPECT_EQ(read(mark + binary_file(false)).surfels.at(1).position, glm::vec3(1.25, -2, 4.5));
  EXPECT_EQ(error_of(mark + mark + std::string(kAscii)),
            ":1: the first line is not \"ply\", expected a PLY file");
}

TEST_F(PointFileTest, ErrorsNameLineOrByte) {
  const std::string ascii(kAscii);
  EXPECT_EQ(error_of("plyx\n"), ":1: the first line is not \"ply\", expected a PLY file");
  EXPECT_EQ(error_of("ply\nformat ascii 2.0\n").find(":2: unknown format, expected"), 0u);
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nelement vertex many\n"),
            ":3: wrong element, expected \"element NAME COUNT\"");
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nproperty float x\n").find(":3: a property stands before"), 0u);
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n").find(":4: wrong property"),
            0u);
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty int x\n")
                .find(":5: property \"x\" is given twice"),
            0u);
  std::string many = "ply\nformat ascii 1.0\nelement vertex 1\n";
  for (int i = 0; i <= 256; ++i) many += fmt::format("property float p{}\n", i);
  EXPECT_EQ(error_of(many), ":260: too many properties, expected at most 256");
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nend_header\n").find(":3: the header has no element vertex"), 0u);
  EXPECT_EQ(error_of("ply\nelement vertex 0\nend_header\n").find(":3: the header has no line \"format\""),
            0u);
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\n"),
            ":3: the file ends within the header, expected \"end_header\"");
  EXPECT_EQ(error_of("ply\n" + std::string(5000, 'x')).find(":2: the header does not end"), 0u);
  EXPECT_EQ(error_of(ascii.substr(0, ascii.size() - 12)),
            ":14: the file ends within its data, expected a number");
  std::string word = ascii;
  word.replace(word.find("nan"), 3, "1,5");
  EXPECT_EQ(error_of(word), ":12: \"1,5\" is no number, expected a number");
  const std::string binary = binary_file(false);
  EXPECT_EQ(error_of(binary.substr(0, binary.size() - 1)),
            fmt::format(": the file ends within its data at byte {}, expected a value of 4 bytes",
                        binary.size() - 4));
}

// A line is a vertex: numbers that are missing or too many would shift all that follow.
TEST_F(PointFileTest, RowsOfTheWrongLengthAreRefused) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement a 1\nproperty list int int i\nproperty int j\nelement vertex 2\n"
      "property float x\nproperty float y\nproperty float z\nelement b 1\nproperty int k\nend_header\n";
  EXPECT_EQ(error_of(head + "2 7 7 5\n1 2 3\n4 5 6\n9\n"), "no error");
  EXPECT_EQ(error_of(head + "\n2 7 7 5\n \n1 2 3\r\n\n4 5 6 \t\n9\n \n\n\t"), "no error") << "blank lines";
  EXPECT_EQ(error_of(head + "2 7 7 5\n1 2 3 4\n4 5 6\n9\n"), ":14: 4 numbers, expected 3");
  EXPECT_EQ(error_of(head + "2 7 7 5\n1 2\n3 4 5 6\n9\n"), ":14: 2 numbers, expected 3");
  EXPECT_EQ(error_of(head + "2 7 7 5\n1 2 3\n4\n9\n"), ":15: 1 number, expected 3");
  EXPECT_EQ(error_of(head + "2 7 7 5\n1 2 3 4 5 6\n9\n"), ":14: 6 numbers, expected 3");
  EXPECT_EQ(error_of(head + "2 7 7 5 5\n1 2 3\n4 5 6\n9\n"), ":13: 5 numbers, expected 4");
  EXPECT_EQ(error_of(head + "2 7 7\n5\n1 2 3\n4 5 6\n9\n"), ":13: 3 numbers, expected more");
  EXPECT_EQ(error_of(head + "2 7 7 5\n1 2 3\n4 5 6\n9 9\n"), ":16: 2 numbers, expected 1");
  EXPECT_EQ(error_of(head + "2 7 7 5\n1 2 3\n4 5 6\n"),
            ":16: the file ends within its data, expected a number");
  EXPECT_EQ(error_of(head + "2 7 7 5\n1 2 3\n4 5 6\n9\n\n7 8 9\n"),
            ":18: a line more than the header counts, expected the end of the file");
}

TEST_F(PointFileTest, HalfAGroupIsRefused) {
  const auto file = [](std::string_view properties) {
    return fmt::format("ply\nformat ascii 1.0\nelement vertex 0\n{}end_header\n", properties);
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_EQ(error_of(file(xyz)), "no error");
  EXPECT_EQ(error_of(file("property float x\nproperty float z\n")),
            ": property y of element vertex is missing, expected x, y and z");
  EXPECT_EQ(error_of(file("property float a\n")).find(": property x, y, z of element vertex is missing"), 0u);
  EXPECT_EQ(error_of(file(xyz + "property float nx\n")),
            ": property ny, nz of element vertex is missing, expected all of its group or none");
  EXPECT_EQ(error_of(file(xyz + "property uchar red\nproperty uchar blue\n")).find(": property green of"),
            0u);
}

// Memory and time are bounded by the file, whatever it declares.
TEST_F(PointFileTest, AbsurdCountsAreRefused) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
  const std::string head = "ply\nformat ascii 1.0\n";
  EXPECT_NE(error_of(head + "element vertex 18446744073709551615\n" + xyz).find("do not fit in its"),
            std::string::npos);
  EXPECT_NE(error_of(head + "element vertex 99999999999999999999\n" + xyz).find(":3: wrong element"),
            std::string::npos);
  EXPECT_EQ(error_of(head + "element a 18446744073709551615\nelement vertex 1\n" + xyz), "no error");
  EXPECT_NE(error_of(head + "element a 18446744073709551615\nproperty int i\nelement vertex 1\n" +
                     xyz.substr(0, xyz.size() - 6) + "0\n")
                .find("the file ends within its data"),
            std::string::npos);
  EXPECT_NE(error_of(head + "element a 1\nproperty list int int i\nelement vertex 1\n" +
                     xyz.substr(0, xyz.size() - 6) + "-3 0 0\n")
                .find("a list of -3 items"),
            std::string::npos);
}

TEST_F(PointFileTest, MutationsDoNoHarm) {
  std::mt19937 random(random_seed());
  const std::string files[] = {binary_file(true), std::string(kAscii)};
  for (int i = 0; i < 2000; ++i) {
    std::string mutant = files[i % 2];
    for (auto flips = 1 + random() % 3; flips > 0; --flips)
      mutant[random() % mutant.size()] = static_cast<char>(random());
    try {
      for (const Surfel& s : scene_of(mutant).surfels) {
        for (int axis = 0; axis < 3; ++axis) ASSERT_TRUE(std::isfinite(s.position[axis]));
        ASSERT_GT(s.radius, 0);
        ASSERT_NEAR(glm::length(s.normal), 1, 1e-5);
      }
    } catch (const UserError&) {
    }
  }
}

std::string with_normals_and_radii(std::string_view rows, int count) {
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float radius\nproperty float red\n"
      "property float green\nproperty float blue\nend_header\n{}",
      count, rows);
}

TEST_F(PointFileTest, SurfelsThatCannotBeDrawnAreCounted) {
  const Scene scene =
      scene_of(with_normals_and_radii("0 0 0  0 0 2   0.5  2 0.5 -1\n"  // drawn
                                      "nan 0 0  0 0 1  1  0 0 0\n"      // not finite
                                      "0 0 0  0 inf 1  1  0 0 0\n",     // not finite
                                      3));
  EXPECT_EQ(scene.surfels.size(), 1u);
  EXPECT_EQ(scene.skipped.not_finite, 2u);
  EXPECT_EQ(scene.estimated.normals + scene.estimated.radii, 0u);
  EXPECT_EQ(scene.surfels[0].normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.surfels[0].color, glm::vec3(1, 0.5, 0));
  EXPECT_EQ(scene.splatting.depth_offset, 0.5) << "a surfel alone has its radius for a spacing";

  const Scene more =
      scene_of(with_normals_and_radii("0 0 0  0 0 1   0  0 0 0\n"       // zero radius
                                      "0 0 0  0 0 1   -1  0 0 0\n"      // zero radius
                                      "0 0 0  0 0 0   1  0 0 0\n"       // zero normal
                                      "0 0 0  1e-40 0 0   1  0 0 0\n",  // drawn: small is not zero
                                      4));
  EXPECT_EQ(more.skipped.zero_radius, 2u);
  EXPECT_EQ(more.skipped.zero_normal, 1u);
  ASSERT_EQ(more.surfels.size(), 1u);
  EXPECT_EQ(more.surfels[0].normal, glm::vec3(1, 0, 0));
}

// Nothing is estimated then.
TEST_F(PointFileTest, NeighboursBesideRadiiAndNormalsAreRefused) {
  const std::string row = "0 0 0  0 0 1   1  0 0 0\n";
  EXPECT_EQ(
      folder_.error_of([&] { scene_of(with_normals_and_radii(row, 1), "neighbours = 9\n"); }),
      "s.toml:3: surfels.neighbours beside a file that has radii and normals, expected it removed, or a "
      "file without one of them");
  EXPECT_EQ(folder_.error_of([&] { scene_of(with_normals_and_radii(row, 1), "neighbours = 8\n"); }),
            "no error")
      << "its default";
  EXPECT_EQ(folder_.error_of([&] { scene_of(kAscii, "neighbours = 9\n"); }), "no error");
}

// Neither for the camera nor for the radii of others.
TEST_F(PointFileTest, SurfelsWithoutANormalCountForNothing) {
  const auto scene = [&](int count, const std::string& rows) {
    return scene_of(
        fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
                    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                    "end_header\n{}",
                    count, rows));
  };
  std::string rows;
  for (int i = 0; i < 25; ++i) rows += fmt::format("{} {} 0 0 0 1\n", i % 5, i / 5);
  const Scene without = scene(25, rows);
  const Scene with = scene(28, "2.1 2 0 0 0 0\n2 2.1 0 0 0 0\n" + rows + "100 0 50 0 0 0\n");
  EXPECT_EQ(with.skipped.zero_normal, 3u);
  EXPECT_EQ(with.camera.eye, without.camera.eye);
  EXPECT_EQ(with.camera.far, without.camera.far);
  ASSERT_EQ(with.surfels.size(), without.surfels.size());
  for (std::size_t i = 0; i < with.surfels.size(); ++i)
    EXPECT_EQ(with.surfels[i].radius, without.surfels[i].radius) << i;
}

TEST_F(PointFileTest, RadiusAndNormalAreEstimated) {
  std::string rows;
  constexpr int kEdge = 9;
  for (int i = 0; i < kEdge * kEdge; ++i) rows += fmt::format("{} {} 5\n", 2 * (i % kEdge), 2 * (i / kEdge));
  const Scene scene = scene_of(
      fmt::format(
          "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
          "end_header\n{}",
          kEdge * kEdge, rows),
      "[camera]\neye = [0, 0, -10]\n");
  ASSERT_EQ(scene.surfels.size(), 81u);
  const Surfel& middle = scene.surfels[40];
  EXPECT_FLOAT_EQ(middle.radius, 2 * std::sqrt(2.0f)) << "the diagonal neighbour is the furthest of 8";
  for (const Surfel& s : scene.surfels) EXPECT_NEAR(s.normal.z, -1, 1e-6) << "toward the eye";
  EXPECT_DOUBLE_EQ(scene.splatting.depth_offset, 2) << "the spacing";
  EXPECT_EQ(scene.estimated.normals, 81u);
  EXPECT_EQ(scene.estimated.radii, 81u);
  EXPECT_EQ(describe(scene.skipped, scene.estimated),
            "none left out, 81 normals estimated, 81 radii estimated");
}

TEST_F(PointFileTest, ADuplicateIsOneWhateverItsNormalsLength) {
  const Scene scene = scene_of(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float radius\nend_header\n"
      "1 1 1 0 0 1 1\n1 1 1 0 0 2 1\n1 1 1 0 0 -1 1\n2 1 1 0 0 1 1\n");
  EXPECT_EQ(scene.skipped.duplicate, 1u);
  EXPECT_EQ(scene.surfels.size(), 3u);
}

TEST_F(PointFileTest, PointsOnOnePlaceOrLineAreLeftOut) {
  const auto file = [](int count, std::string_view rows) {
    return fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n{}",
        count, rows);
  };
  const SkipCounts one_place = scene_of(file(3, "1 1 1\n1 1 1\n1 1 1")).skipped;
  EXPECT_EQ(one_place.duplicate, 2u);
  EXPECT_EQ(one_place.zero_radius, 1u);
  EXPECT_EQ(scene_of(file(1, "1 1 1")).skipped.zero_radius, 1u);
  EXPECT_EQ(scene_of(file(3, "1 1 1\n2 2 2\n3 3 3")).skipped.zero_normal, 3u);
  EXPECT_TRUE(scene_of(file(1, "nan 1 1")).surfels.empty()) << "load_scene refuses it";
}

TEST_F(PointFileTest, ASceneNeedsSurfels) {
  const auto error = [&](std::string_view file) {
    write_file(ply_, file);
    write_file(folder_ / "s.toml", "[surfels]\nfile = \"p.ply\"\n");
    return folder_.error_of([&] { load_scene(folder_ / "s.toml"); });
  };
  EXPECT_EQ(error(with_normals_and_radii("", 0)), "p.ply: no vertices, expected the surfels of a scene");
  EXPECT_EQ(error(with_normals_and_radii("0 0 0  0 0 1  0  1 1 1\n", 1)),
            "s.toml: none of its surfels can be drawn: 1 left out (1 of radius 0), expected at least one "
            "that can");
}

TEST_F(PointFileTest, MissingFileIsTheUsersError) {
  EXPECT_THROW(read_ply(folder_ / "none.ply"), UserError);
  EXPECT_THROW(read_ply(folder_.path()), UserError);
  EXPECT_THROW(read_ply("/dev/null"), UserError);
}

}  // namespace
}  // namespace splatscope::traces
