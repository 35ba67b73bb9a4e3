// Any bytes: an error or a volume, and a small volume a scene; never a crash. Run: tests/fuzz/README.md.
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

#include "model/error.h"
#include "traces/fuzz_file.h"
#include "traces/volumes/nrrd_file.h"
#include "traces/volumes/volume_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace splatscope;
  static const traces::FuzzFile file(".nrrd");
  file.write(data, size);
  try {
    constexpr std::size_t kSmall = 64;  // voxels
    if (traces::read_nrrd(file.path()).values.size() > kSmall) return 0;
    traces::parse_volume_scene(fmt::format("[volume]\nfile = \"{}\"\n", file.path().string()), "fuzz.toml")
        .splats();
  } catch (const UserError&) {
  }
  return 0;
}
