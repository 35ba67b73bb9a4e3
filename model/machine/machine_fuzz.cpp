// Any text: an error or a machine, never a crash; and any text as a setting. Run: tests/fuzz/README.md.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "model/error.h"
#include "model/machine/machine.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace splatscope;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    machine::parse(text, "fuzz");
  } catch (const UserError&) {
  }
  try {
    Machine machine;
    machine::set(machine, text.substr(0, text.find('\n')));
  } catch (const UserError&) {
  }
  return 0;
}
