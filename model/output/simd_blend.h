#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "model/command/commands.h"

namespace splatscope::output {

// write_colors into an 8-bit frame without blending, or with a destination factor of one and a source factor
// that does not depend on the destination. Under the one rounding of such a blend the destination is added
// whole, so everything but that addition is done for many fragments at once.
void add_unorm8(const std::array<const float*, 4>& colors, std::span<const std::uint32_t> pixels,
                const DrawState& state, std::span<Color8> frame);

}  // namespace splatscope::output
