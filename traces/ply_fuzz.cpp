// Any bytes: an error or surfels, and few surfels a scene; never a crash. Run: tests/fuzz/README.md.
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

#include "model/error.h"
#include "traces/fuzz_file.h"
#include "traces/models/ply_text.h"
#include "traces/point_file.h"
#include "traces/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace splatscope;
  static const traces::FuzzFile file(".ply");
  file.write(data, size);
  try {
    if (traces::ply_has_faces(file.path())) {
      traces::ply_text(file.path());  // what assimp would read
      return 0;
    }
    if (traces::read_ply(file.path()).surfels.size() > 32) return 0;
    traces::parse_scene(fmt::format("[surfels]\nfile = \"{}\"\n", file.path().string()), "fuzz.toml");
  } catch (const UserError&) {
  }
  return 0;
}
