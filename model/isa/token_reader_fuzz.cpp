// Any bytes: an error or a program, never a crash. Run: tests/fuzz/README.md.
#include <cstddef>
#include <cstdint>
#include <span>

#include "model/error.h"
#include "model/isa/fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace splatscope;
  try {
    isa::exercise(
        isa::read_tokens(isa::tokens_of_bytes(std::as_bytes(std::span(data, size)), "fuzz"), "fuzz"));
  } catch (const UserError&) {
  }
  return 0;
}
