#pragma once

#include "model/isa/program.h"

// Registers, read ports and slots of the pixel versions ("Registers - ps_1_X", "Pixel Shader Differences").
namespace splatscope::isa {

inline constexpr int kPixelConstants = 8;
inline constexpr int kPixelArithmeticSlots = 8;  // in ps_1_4: a phase

struct PixelLimits {
  int temporaries, textures, texture_slots;  // texture slots in ps_1_4: a phase
  int temporary_ports, texture_ports;

  constexpr int count(RegisterFile file) const {
    switch (file) {
      case RegisterFile::temporary:
        return temporaries;
      case RegisterFile::texture:
        return textures;
      case RegisterFile::constant:
        return kPixelConstants;
      case RegisterFile::input:
        return 2;
      default:
        return 0;
    }
  }
  constexpr int read_ports(RegisterFile file) const {
    switch (file) {
      case RegisterFile::temporary:
        return temporary_ports;
      case RegisterFile::texture:
        return texture_ports;
      default:
        return 2;
    }
  }
};

constexpr PixelLimits pixel_limits(Version version) {
  if (version.minor == 4) return {6, 6, 6, 3, 1};
  return {2, 4, 4, 2, version.minor == 1 ? 2 : 3};
}

}  // namespace splatscope::isa
