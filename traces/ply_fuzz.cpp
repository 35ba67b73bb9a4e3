// Any bytes: an error or surfels, and few surfels a scene; never a crash. Run: tests/fuzz/README.md.
#include <fmt/format.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "model/error.h"
#include "traces/point_file.h"
#include "traces/scene.h"

namespace {

// The file that is written anew for each input.
struct Scratch {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("splatscope-fuzz-{}.ply", ::getpid());
  ~Scratch() { std::filesystem::remove(path); }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace splatscope;
  static const Scratch file;
  std::ofstream(file.path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    if (traces::ply_has_faces(file.path)) return 0;  // a mesh: assimp's
    if (traces::read_ply(file.path).surfels.size() > 32) return 0;
    traces::parse_scene(fmt::format("[surfels]\nfile = \"{}\"\n", file.path.string()), "fuzz.toml");
  } catch (const UserError&) {
  }
  return 0;
}
