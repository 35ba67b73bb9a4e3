#include <cstring>

#include "cases.h"

namespace splatscope::tests {
namespace {

constexpr int kRows = 40;
constexpr const char* kProperties =
    "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
    "property float nz\nproperty float radius\n";

std::string header(std::string_view format, std::string_view count,
                   std::string_view properties = kProperties) {
  return fmt::format("ply\nformat {} 1.0\nelement vertex {}\n{}end_header\n", format, count, properties);
}

std::string ascii_surfels() {
  std::string text = header("ascii", fmt::format("{}", kRows));
  for (int i = 0; i < kRows; ++i) text += fmt::format("{} {} 0 0 0 1 0.5\n", i % 8, i / 8);
  return text;
}

std::string binary_surfels(float value_of_all = 1) {
  std::string text = header("binary_little_endian", fmt::format("{}", kRows));
  const float values[7] = {value_of_all, value_of_all, value_of_all, value_of_all,
                           value_of_all, value_of_all, value_of_all};
  for (int i = 0; i < kRows; ++i) text.append(reinterpret_cast<const char*>(values), sizeof values);
  return text;
}

// A scene of the file, and a sampling of it.
class Models : public BadInputs {
 public:
  Models() { file("s.toml", "[surfels]\nfile = \"bad.ply\"\n[frame]\nwidth = 32\nheight = 32\n"); }
  void refused_ply(const std::string& what, const std::string& text) {
    file("bad.ply", text);
    refused(what, {"record", "s.toml", "-o", "s.trace"});
  }
};

TEST(BadInputs, SurfelFilesCutShort) {
  Models inputs;
  const auto refused = [&](const std::string& what) {
    inputs.refused(what, {"record", "s.toml", "-o", "s.trace"});
  };
  inputs.cut("bad.ply", ascii_surfels(), refused);
  inputs.cut("bad.ply", binary_surfels(), refused);
  EXPECT_GE(inputs.count(), 30);
}

TEST(BadInputs, SurfelFilesOfNoNumbers) {
  Models inputs;
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity(), 0.0f})
    inputs.refused_ply(fmt::format("{} everywhere", value), binary_surfels(value));
  for (const char* number : {"nan", "inf", "1e999", "-1e999", "0x10", "1,5", "--1", "1e", "one"})
    inputs.refused_ply(number, header("ascii", "1") + fmt::format("{0} {0} {0} {0} {0} {0} {0}\n", number));
}

TEST(BadInputs, SurfelFilesOfAbsurdSize) {
  Models inputs;
  for (const char* count : {"41", "1000000000", "4294967296", "18446744073709551615", "18446744073709551616",
                            "-1", "1e3", "", "NaN"}) {
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
      inputs.refused_ply(fmt::format("{} vertices", count), header(format, count) + std::string(40, '1'));
  }
  const std::string list = "element face 4000000000\nproperty list uint int vertex_indices\n";
  inputs.refused_ply("faces first", "ply\nformat ascii 1.0\n" + list + "element vertex 1\n" + kProperties +
                                        "end_header\n1\n");
  inputs.refused_ply("a list of 4294967295 items",
                     "ply\nformat binary_little_endian 1.0\nelement odd 1\nproperty list uint double a\n"
                     "element vertex 1\n" +
                         std::string(kProperties) + "end_header\n\xff\xff\xff\xff" + std::string(100, '\0'));
  inputs.refused_ply("a list of -1 items",
                     "ply\nformat ascii 1.0\nelement odd 1\nproperty list int int a\n"
                     "element vertex 1\n" +
                         std::string(kProperties) + "end_header\n-1\n0 0 0 0 0 1 1\n");
}

TEST(BadInputs, SurfelFilesWithAWrongHeader) {
  Models inputs;
  const std::string good = kProperties;
  const std::pair<const char*, std::string> bad[] = {
      {"empty", ""},
      {"another first line", "plyy\n"},
      {"no format", "ply\nelement vertex 0\n" + good + "end_header\n"},
      {"a later version", "ply\nformat ascii 2.0\nelement vertex 0\n" + good + "end_header\n"},
      {"an unknown format", header("binary_middle_endian", "1")},
      {"no vertex", "ply\nformat ascii 1.0\nend_header\n"},
      {"no end", "ply\nformat ascii 1.0\nelement vertex 1\n" + good},
      {"no z", header("ascii", "1", "property float x\nproperty float y\n") + "1 2\n"},
      {"half a normal", header("ascii", "1",
                               "property float x\nproperty float y\nproperty float z\n"
                               "property float nx\n") +
                            "1 2 3 4\n"},
      {"a list for x",
       header("ascii", "1", "property list uchar float x\nproperty float y\nproperty float z\n") + "1 2\n"},
      {"a property twice", header("ascii", "1", good + "property float x\n") + "1 2\n"},
      {"an unknown type", header("ascii", "1", "property float16 x\n") + "1\n"},
      {"a property before any element", "ply\nformat ascii 1.0\nproperty float x\nend_header\n"},
      {"a line of 100000 bytes", "ply\ncomment " + std::string(100000, 'x') + "\n"},
      {"zeros", std::string(4096, '\0')},
      {"only \"ply\"", "ply"},
  };
  for (const auto& [what, text] : bad) inputs.refused_ply(what, text);
  std::string long_header = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 20000; ++i) long_header += "comment\n";
  inputs.refused_ply("20000 lines", long_header);
  std::string properties;
  for (int i = 0; i < 300; ++i) properties += fmt::format("property float p{}\n", i);
  inputs.refused_ply("300 properties", header("ascii", "1", properties));
}

std::string little_endian(std::uint32_t value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

// Of three vertices.
std::string ascii_mesh(int faces, std::string_view data) {
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list int int vertex_indices\nend_header\n{}",
      faces, data);
}

TEST(BadInputs, MeshesThatAreNone) {
  BadInputs inputs;
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string stl_head = std::string(80, ' ');
  const std::pair<const char*, std::string> bad[] = {
      {"empty.obj", ""},
      {"empty.off", ""},
      {"empty.stl", ""},
      {"empty.ply", ""},
      {"empty.gltf", ""},
      {"empty.glb", ""},
      {"zeros.obj", std::string(4096, '\0')},
      {"zeros.off", std::string(4096, '\0')},
      {"zeros.stl", std::string(4096, '\0')},
      {"zeros.glb", std::string(4096, '\0')},
      {"points.obj", triangle},
      {"beyond.obj", triangle + "f 1 2 900\n"},
      {"nan.obj", "v nan nan nan\nv nan nan nan\nv nan nan nan\nf 1 2 3\n"},
      {"missing_number.obj", triangle + "v 1 1\nf 1 2 3\n"},
      {"word.obj", triangle + "v 1 one 1\nf 1 2 3\n"},
      {"flat.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n"},
      {"huge.off", "OFF\n4000000000 4000000000 0\n0 0 0\n"},
      {"negative.off", "OFF\n-3 -1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"nan.off", "OFF\nnan nan 0\n"},
      {"missing_face.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"missing_corner.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"},
      {"cut.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"},
      {"huge.stl", stl_head + little_endian(0xffffffffu) + std::string(50, '\0')},
      {"many.stl", stl_head + little_endian(100000000u) + std::string(50, '\0')},
      {"cut.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0"},
      {"itself.gltf",
       "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"itself.gltf\",\"byteLength\":4000000000}],"
       "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[0]}]}"},
      {"cycle.gltf",
       "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
       "\"nodes\":[{\"children\":[1]},{\"children\":[0]}]}"},
      {"missing.gltf",
       "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"none.bin\",\"byteLength\":36}]}"},
      {"cut.gltf", "{\"asset\":{\"version\":"},
      {"cut.glb", "glTF" + little_endian(2) + little_endian(0xffffffffu)},
      {"huge.ply",
       "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
       "property float y\nproperty float z\nelement face 4000000000\n"
       "property list uchar int vertex_indices\nend_header\n"},
      {"faces.ply", ascii_mesh(1, "0 0 0\n1 0 0\n0 1 0\n3 0 1 77\n")},
      {"missing_faces.ply", ascii_mesh(2, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")},
      {"missing_number.ply", ascii_mesh(1, "0 0 0\n1 0\n0 1 0\n3 0 1 2\n")},
      {"minus_3_corners.ply", ascii_mesh(1, "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n")},
      {"many_corners.ply", ascii_mesh(1, "0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n")},
      {"mesh.xyz", "0 0 0\n"},
      {"mesh", triangle + "f 1 2 3\n"},
  };
  for (const auto& [name, text] : bad) {
    inputs.file(name, text);
    inputs.refused("a mesh", {"sample", name, "-n", "10", "-o", "s.ply"});
  }
}

TEST(BadInputs, MeshesCutShort) {
  BadInputs inputs;
  std::string obj = "mtllib none.mtl\n", off = "OFF\n16 9 0\n",
              ply =
                  "ply\nformat ascii 1.0\nelement vertex 16\n"
                  "property float x\nproperty float y\nproperty float z\nelement face 9\n"
                  "property list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 16; ++i) {
    const std::string point = fmt::format("{} {} {}\n", i % 4, i / 4, i % 3);
    obj += "v " + point;
    off += point;
    ply += point;
  }
  for (int i = 0; i < 9; ++i) {
    const int corner = i % 3 + i / 3 * 4;
    obj += fmt::format("f {} {} {} {}\n", corner + 1, corner + 2, corner + 6, corner + 5);
    const std::string face = fmt::format("4 {} {} {} {}\n", corner, corner + 1, corner + 5, corner + 4);
    off += face;
    ply += face;
  }
  inputs.cut("cut.obj", obj, [&](const std::string& what) {
    inputs.refused_or_used(what, {"sample", "cut.obj", "-n", "10", "-o", "s.ply"});
  });
  for (const auto& [name, text] : {std::pair{"cut.off", off}, std::pair{"cut.ply", ply}}) {
    inputs.cut(name, text, [&, name = name](const std::string& what) {
      inputs.refused(what, {"sample", name, "-n", "10", "-o", "s.ply"});
    });
  }
  EXPECT_GE(inputs.count(), 10);
}

}  // namespace
}  // namespace splatscope::tests
