#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace splatscope::traces {

// A picture wrapped around a mesh: 8 bits a channel, r g b, rows from the top.
struct TextureImage {
  std::size_t width = 0, height = 0;  // texels, > 0
  std::vector<std::uint8_t> texels;   // 3 bytes each

  // Bilinear, repeating; (0, 0) is the picture's lower left corner.
  glm::vec3 at(const glm::vec2& texcoord) const;
};

// By OpenImageIO: any format that it reads, at most 16384 texels a side. Nothing where that fails.
std::optional<TextureImage> read_texture(const std::filesystem::path& path);
// The same from a file in memory; its format is recognised by `ending` ("png").
std::optional<TextureImage> read_texture(std::span<const std::byte> file, const std::string& ending);

}  // namespace splatscope::traces
