#include <fstream>

#include "command_line.h"

namespace splatscope::tests {
namespace {

// Files that only a scene names, or a mesh or a header that it names, are not written over.
class NamedFiles : public testing::Test {
 protected:
  const ScratchFolder folder_;
};

// Two, each of "x y z" and three numbers more.
std::string points(const std::string& properties) {
  return "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n" +
         properties + "end_header\n0 0 0 1 1 1\n1 0 0 1 1 1\n";
}

// A NRRD header of 2 x 2 x 2 floats, or of so many groups of three.
std::string grid(const std::string& sizes, const std::string& more) {
  return "NRRD0004\ntype: float\nencoding: raw\nendian: little\ndimension: " +
         std::string(sizes.empty() ? "3" : "4") + "\nsizes: " + sizes + "2 2 2\n" + more;
}

TEST_F(NamedFiles, OfSurfels) {
  folder_.file("scene.toml", "[surfels]\nfile = \"a.ply\"\n");
  folder_.file("a.ply", points("property float nx\nproperty float ny\nproperty float nz\n"));
  expect_refused(folder_, {"record", "scene.toml", "-o", "./a.ply"},
                 "./a.ply: is named by -o and by the scene (a.ply)");
  expect_refused(folder_, {"run", "scene.toml", "--out", "o", "--counters", "a.ply"},
                 "a.ply: is named by --counters and by the scene");
}

TEST_F(NamedFiles, OfAMesh) {
  folder_.file("mesh.toml", "[surfels]\nfile = \"square.obj\"\ncount = 20\n");
  folder_.file("square.obj",
               "mtllib square.mtl\nusemtl paint\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
  folder_.file("square.mtl", "newmtl paint\nKd 1 0 0\nmap_Kd frame.png\nmap_Bump bump.png\nmap_d d.png\n");
  folder_.file("frame.png", "no picture, which is read as one");
  expect_refused(folder_, {"record", "mesh.toml", "-o", "square.obj"}, "by -o and by the scene (square.obj)");
  expect_refused(folder_, {"record", "mesh.toml", "-o", "square.mtl"},
                 "square.mtl: is named by -o and by the mesh");
  expect_refused(folder_, {"sample", "square.obj", "-n", "20", "-o", "square.mtl"}, "by -o and by the mesh");
  expect_refused(folder_, {"sample", "square.obj", "-n", "20", "-o", "frame.png"},
                 "by -o and by the mesh (frame.png)");
  for (const char* texture : {"bump.png", "d.png"})
    expect_refused(folder_, {"sample", "square.obj", "-n", "20", "-o", texture}, "by -o and by the mesh");
  expect_refused(folder_, {"run", "mesh.toml", "--out", "."}, "by the mesh and by a result in --out");
  folder_.file("bare.obj", "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  expect_refused(folder_, {"sample", "bare.obj", "-n", "20", "-o", "paint.mtl"},
                 "by -o and by the mesh (paint.mtl)");
}

// Sampling can take minutes: this mesh is one that it would refuse.
TEST_F(NamedFiles, OfAMeshBeforeItIsSampled) {
  folder_.file("flat.obj", "mtllib flat.mtl\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  folder_.file("flat.mtl", "newmtl paint\n");
  expect_refused(folder_, {"sample", "flat.obj", "-o", "o.ply"}, "no triangle of it has a surface");
  expect_refused(folder_, {"sample", "flat.obj", "-o", "flat.mtl"}, "by -o and by the mesh (flat.mtl)");
}

TEST_F(NamedFiles, OfAVolume) {
  folder_.file("grid.toml", "[volume]\nfile = \"a.nhdr\"\npositions = \"p.nhdr\"\n");
  folder_.file("a.nhdr", grid("", "data file: frame.exr\n"));
  folder_.file("frame.exr", std::string(32, '\0'));
  folder_.file("p.nhdr", grid("3 ", "data file: p.raw\n"));
  std::ofstream places(folder_.path() / "p.raw", std::ios::binary);
  for (int i = 0; i < 24; ++i) {
    const float place = (i / 3) >> (i % 3) & 1 ? 1.0f : 0.0f;
    places.write(reinterpret_cast<const char*>(&place), sizeof(place));
  }
  places.close();
  expect_refused(folder_, {"record", "grid.toml", "-o", "p.nhdr"}, "by -o and by the scene (p.nhdr)");
  expect_refused(folder_, {"record", "grid.toml", "-o", "p.raw"},
                 "p.raw: is named by -o and by the header (p.raw)");
  expect_refused(folder_, {"record", "grid.toml", "-o", "frame.exr"}, "by -o and by the header (frame.exr)");
  expect_refused(folder_, {"volume", "grid.toml", "--out", "."},
                 "by the header and by a result in --out (./frame.exr)");
}

TEST_F(NamedFiles, OfIrregularSamples) {
  folder_.file("set.toml", "[volume]\nsamples = \"results.json\"\n");
  folder_.file("results.json", points("property float value\nproperty float radius\nproperty float w\n"));
  expect_refused(folder_, {"run", "set.toml", "--out", "."}, "by the scene and by a result in --out");
  expect_refused(folder_, {"volume", "set.toml", "--out", "."}, "by the scene and by a result in --out");
  expect_refused(folder_, {"sweep", "set.toml", "--sweep", "vertex.units=1,2", "--out", "."},
                 "results.json: is named by the scene and by a result in --out");
}

}  // namespace
}  // namespace splatscope::tests
