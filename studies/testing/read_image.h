#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "model/error.h"
#include "pictures/decoder.h"
#include "studies/image_io.h"

// What tests look at pictures by.
namespace splatscope::studies::testing {

// Throws UserError where the file is missing or no picture. Any number of channels becomes RGBA.
inline Image read_image(const std::filesystem::path& path) {
  constexpr std::size_t kMost = 16384;  // pixels a side
  std::string why;
  const auto decoded = pictures::decoder().read_floats({path.string()}, 4, kMost, &why);
  if (!decoded && why.empty())
    throw UserError(path.string(), 0, "cannot be read, expected a picture (EXR or PNG)");
  if (!decoded) throw UserError(path.string(), 0, fmt::format("is damaged ({}), expected a picture", why));
  Image image(static_cast<int>(decoded->width), static_cast<int>(decoded->height));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {0, 0, 0, 1};
    for (std::size_t c = 0; c < decoded->channels; ++c)
      image.pixels[i][c] = decoded->values[i * decoded->channels + c];
    if (decoded->channels < 3) image.pixels[i][1] = image.pixels[i][2] = image.pixels[i][0];
  }
  return image;
}

}  // namespace splatscope::studies::testing
