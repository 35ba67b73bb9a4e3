// Any text: one line of JSON that answers the case, never a crash. Run: tests/fuzz/README.md.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>

#include "studies/shader_batch.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace splatscope;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const Arithmetic arithmetic : {Arithmetic::ieee, Arithmetic::nv20}) {
    const studies::ShaderResult result = studies::run_shader_case(text, arithmetic);
    const auto answer = nlohmann::json::parse(result.json, nullptr, false);
    const bool is_answer = answer.is_object() && answer.contains("outputs") != answer.contains("error");
    if (!is_answer || result.json.find('\n') != std::string::npos) std::abort();
  }
  return 0;
}
