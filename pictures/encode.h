#pragma once

#include <cstddef>
#include <string>
#include <vector>

// Picture files by libpng and OpenEXR, which bring few libraries with them.
namespace splatscope::pictures {

struct Picture {
  std::size_t width = 0, height = 0, channels = 0;
  std::string channel = {};  // name of a single one; "Z" is depth
  const float* values = nullptr;
  std::size_t pixel_stride = 0;  // floats from one pixel to the next; rows follow one another
};

// The bytes of a file: 8 bits a channel, grey or RGB, the last of 2 or 4 channels alpha; sRGB as it is. What
// is not in [0, 1] goes to the nearest end, NaN to 0. Empty where `asked_to_stop` is true before the library
// begins, which takes a second for the largest frame. Throws std::runtime_error where the library fails.
std::vector<std::byte> encode_png(const Picture& picture, bool (*asked_to_stop)());

// The same: binary32, of several channels R, G, B and A. It can be stopped every few rows.
std::vector<std::byte> encode_exr(const Picture& picture, bool (*asked_to_stop)());

}  // namespace splatscope::pictures
