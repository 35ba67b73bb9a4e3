// Any text: an error or a program, never a crash. Run: tests/fuzz/README.md.
#include <cstddef>
#include <cstdint>

#include "model/error.h"
#include "model/isa/fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace splatscope;
  try {
    isa::exercise(isa::assemble({reinterpret_cast<const char*>(data), size}, "fuzz"));
  } catch (const UserError&) {
  }
  return 0;
}
