#include "traces/models/ply_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <glm/vec3.hpp>

#include "model/testing/append_bytes.h"
#include "model/testing/scratch_folder.h"
#include "traces/models/mesh_file.h"

namespace splatscope::traces {
namespace {

constexpr std::string_view kVertex =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
constexpr std::string_view kFace = "element face 2\nproperty list uchar int vertex_indices\n";
// Of no mesh, but of many scans.
constexpr std::string_view kCamera =
    "element camera 2\nproperty float view_px\nproperty list uchar int seen\n";

const std::vector<glm::vec3> kPositions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

class PlyText : public testing::Test {
 protected:
  Mesh mesh_of(std::string_view text) const { return read_mesh(folder_.file("m.ply", text)).model.mesh; }
  std::string error_of(std::string_view text) const {
    return folder_.error_of([&] { mesh_of(text); });
  }

  ScratchFolder folder_;
};

// The same square in all of these: assimp gives each corner of a triangle a vertex of its own, or not.
void expect_square(const Mesh& mesh, const std::string& name, glm::vec3 first = kPositions[0]) {
  ASSERT_EQ(mesh.triangles.size(), 2u) << name;
  const std::uint32_t corners[2][3] = {{0, 1, 2}, {0, 2, 3}};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(mesh.positions[mesh.triangles[i][c]], corners[i][c] == 0 ? first : kPositions[corners[i][c]])
          << name;
}

struct Part {
  std::string_view header, ascii;
};
constexpr Part kParts[] = {{kVertex, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"},
                           {kFace, "3 0 1 2\n3 0 2 3\n"},
                           {kCamera, "0.5 2 7 8\n0.25 0\n"}};

// The data of kParts[part], the first x by its bits.
std::string binary_data(int part, bool big_endian, std::uint32_t first_x = 0) {
  std::string bytes;
  const auto put = [&](auto value) { append_bytes(bytes, value, big_endian); };
  const auto list = [&](std::initializer_list<std::int32_t> items) {
    put(static_cast<std::uint8_t>(items.size()));
    for (const std::int32_t item : items) put(item);
  };
  if (part == 0) {
    for (const glm::vec3& p : kPositions)
      for (int c = 0; c < 3; ++c)
        put(&p == kPositions.data() && c == 0 ? std::bit_cast<float>(first_x) : p[c]);
  } else if (part == 1) {
    list({0, 1, 2});
    list({0, 2, 3});
  } else {
    put(0.5f);
    list({7, 8});
    put(0.25f);
    list({});
  }
  return bytes;
}

TEST_F(PlyText, ElementsThatAssimpDoesNotKnowAreLeftOut) {
  for (const auto& order : {std::array{2, 0, 1}, std::array{0, 2, 1}, std::array{0, 1, 2}}) {
    std::string header, ascii, little, big;
    for (const int part : order) {
      header += kParts[part].header;
      ascii += kParts[part].ascii;
      little += binary_data(part, false);
      big += binary_data(part, true);
    }
    const std::string name = fmt::format("camera at {}", std::ranges::find(order, 2) - order.begin());
    const auto whole = [&](std::string_view format, const std::string& data) {
      return fmt::format("ply\nformat {} 1.0\n{}end_header\n{}", format, header, data);
    };
    expect_square(mesh_of(whole("ascii", ascii)), name);
    expect_square(mesh_of(whole("binary_little_endian", little)), name + ", little-endian");
    expect_square(mesh_of(whole("binary_big_endian", big)), name + ", big-endian");
  }
}

TEST_F(PlyText, BinaryDataMayBeginWithALineEnd) {
  for (const std::uint32_t byte : {0x0au, 0x0bu, 0x0du, 0x20u}) {
    for (const std::string_view end : {"\n", "\r\n"}) {
      const std::uint32_t x = 0x3d000000u | byte;  // about 1/32
      std::string header =
          fmt::format("ply\nformat binary_little_endian 1.0\n{}{}end_header\n", kVertex, kFace);
      for (std::size_t at = 0; end.size() == 2 && (at = header.find('\n', at)) != header.npos; at += 2)
        header.replace(at, 1, end);
      expect_square(mesh_of(header + binary_data(0, false, x) + binary_data(1, false)),
                    fmt::format("0x{:02x} behind {} bytes", byte, end.size()),
                    {std::bit_cast<float>(x), 0, 0});
    }
  }
}

TEST_F(PlyText, BlankLinesArePassedOver) {
  const std::string header = fmt::format("ply\nformat ascii 1.0\n{}{}end_header\n", kVertex, kFace);
  for (const std::string_view blank : {"\n", "\n\n", " \n", "\r\n", "\t \r\n"})
    for (const int before : {0, 2, 4, 5, 6}) {
      std::string text = header;
      int row = 0;
      for (const std::string_view line :
           {"0 0 0\n", "1 0 0\n", "1 1 0\n", "0 1 0\n", "3 0 1 2\n", "3 0 2 3\n"}) {
        if (row++ == before) text += blank;
        text += line;
      }
      if (before == 6) text += blank;
      expect_square(mesh_of(text), fmt::format("{} before row {}", blank, before));
    }
}

TEST_F(PlyText, CommentsMayStandBeforeTheFormat) {
  expect_square(mesh_of(fmt::format("ply\ncomment from a scanner\n\nobj_info 1\nformat ascii 1.0\n{}comment "
                                    "element face 7\n{}end_header\n{}{}",
                                    kVertex, kFace, kParts[0].ascii, kParts[1].ascii)),
                "comments");
}

// assimp reads on behind a comment, or what else it does not know in a header, as if there were none before.
TEST_F(PlyText, CommentsMayStandAnywhereInTheHeader) {
  std::vector<std::string> lines;
  for (const std::string_view part : {kVertex, kFace})
    for (std::size_t at = 0, end; (end = part.find('\n', at)) != part.npos; at = end + 1)
      lines.emplace_back(part.substr(at, end + 1 - at));
  for (const std::string_view comment : {"comment c\n", "obj_info 1\n", "comment TextureFile a.png\n", "\n"})
    for (std::size_t before = 0; before <= lines.size(); ++before) {
      std::string text = "end_header\n";
      for (std::size_t i = lines.size() + 1; i-- > 0;)
        text = (i == before ? std::string(comment) : "") + (i < lines.size() ? lines[i] : "") + text;
      const std::string name = fmt::format("{} before line {}", comment, before);
      expect_square(mesh_of("ply\nformat ascii 1.0\n" + text + std::string(kParts[0].ascii) +
                            std::string(kParts[1].ascii)),
                    name);
      expect_square(mesh_of("ply\nformat binary_little_endian 1.0\n" + text + binary_data(0, false) +
                            binary_data(1, false)),
                    name + ", binary");
    }
}

TEST_F(PlyText, ElementsMayHaveNoPropertiesAndFacesComeFirst) {
  expect_square(
      mesh_of(fmt::format("ply\nformat ascii 1.0\nelement edge 2\nelement material 3\n{}{}end_header\n{}{}",
                          kFace, kVertex, kParts[1].ascii, kParts[0].ascii)),
      "faces first");
}

TEST_F(PlyText, NumbersAreOfTheTypesOfTheHeader) {
  const auto with = [&](std::string_view x, std::string_view index) {
    return fmt::format(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty float y\nproperty float "
        "z\n{}end_header\n0 0 0\n{} 0 0\n0\r1 0\n3 0 1 {}\n3 0 2 1\n",
        kFace, x, index);
  };
  EXPECT_EQ(mesh_of(with("-1", "+2")).triangles.size(), 2u);
  EXPECT_EQ(error_of(with("1.5", "2")), "m.ply:11: \"1.5\" is no whole number, expected a value of type int");
  EXPECT_EQ(error_of(with("1", "2.0")), "m.ply:13: \"2.0\" is no whole number, expected a value of type int");
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nformat binary_little_endian 1.0\nend_header\n"),
            "m.ply:3: a second line \"format\", expected one");
}

TEST_F(PlyText, HalfAGroupIsRefused) {
  const auto with = [&](std::string_view properties, std::string_view row) {
    return fmt::format("ply\nformat ascii 1.0\nelement vertex 3\n{}{}end_header\n{}{}{}3 0 1 2\n3 0 2 1\n",
                       properties, kFace, row, row, row);
  };
  constexpr std::string_view kXyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_EQ(error_of(with(fmt::format("{}property float nx\nproperty float ny\n", kXyz), "0 0 0 1 0\n")),
            "m.ply: property nz of element vertex is missing, expected all of its group or none");
  EXPECT_EQ(error_of(with(fmt::format("{}property uchar red\n", kXyz), "0 0 0 1\n")),
            "m.ply: property green, blue of element vertex is missing, expected all of its group or none");
  EXPECT_EQ(error_of(with("property float x\nproperty float y\n", "0 0\n")),
            "m.ply: property z of element vertex is missing, expected x, y and z");
}

}  // namespace
}  // namespace splatscope::traces
