// Any text: an error or the settings of a scene, never a crash. Run: tests/fuzz/README.md.
#include <cstddef>
#include <cstdint>

#include "model/error.h"
#include "traces/scene_settings.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace splatscope;
  try {
    traces::parse_settings({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const UserError&) {
  }
  return 0;
}
