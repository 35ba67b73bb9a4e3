#include "traces/models/gltf_check.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>

#include "model/error.h"
#include "model/input_file.h"

namespace splatscope::traces {
namespace {

using nlohmann::json;

// The JSON of a file: all of a .gltf, the first chunk of a .glb, whose three words of header and two of the
// chunk stand before it.
std::string json_text(const std::filesystem::path& path) {
  std::string text = file_bytes(path);
  constexpr std::size_t kHeader = 20;
  if (!text.starts_with("glTF") || text.size() < kHeader) return text;
  std::uint32_t length = 0;
  std::memcpy(&length, text.data() + 12, sizeof(length));
  return text.substr(kHeader, length);
}

// What `container` holds under `key`; null where there is none, or where it holds something else.
template <typename Key>
const json& at(const json& container, const Key& key) {
  static const json kNone;
  if constexpr (std::is_integral_v<Key>) {
    return container.is_array() && key < container.size() ? container[key] : kNone;
  } else {
    return container.is_object() && container.contains(key) ? container[key] : kNone;
  }
}

// Those that a mesh and its colours do without.
bool is_harmless(std::string_view extension) {
  return extension.starts_with("KHR_materials_") || extension == "KHR_lights_punctual";
}

bool holds_coordinates(std::string_view attribute) {
  return attribute == "POSITION" || attribute == "NORMAL" || attribute.starts_with("TEXCOORD_");
}

}  // namespace

void expect_plain_gltf(const std::filesystem::path& path) {
  const json file = json::parse(json_text(path), nullptr, false);
  for (const json& name : at(file, "extensionsRequired"))
    if (name.is_string() && !is_harmless(name.get_ref<const std::string&>()))
      throw UserError(
          path.string(), 0,
          fmt::format("requires the extension {}, expected a mesh that can be read without it", name.dump()));
  constexpr int kFloat = 5126;  // GL_FLOAT
  for (const json& mesh : at(file, "meshes"))
    for (const json& primitive : at(mesh, "primitives"))
      for (const auto& [name, accessor] : at(primitive, "attributes").items()) {
        if (!holds_coordinates(name) || !accessor.is_number_unsigned()) continue;
        const json& type = at(at(at(file, "accessors"), accessor.get<std::size_t>()), "componentType");
        if (type.is_number() && type != kFloat)
          throw UserError(path.string(), 0,
                          fmt::format("holds {} in integers, expected floats (componentType 5126)", name));
      }
}

}  // namespace splatscope::traces
