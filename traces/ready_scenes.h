#pragma once

#include <span>

#include "model/embedded_file.h"

namespace splatscope {

// The scenes of traces/scenes, part of the program. The build makes this function's text (splatscope_embed).
std::span<const EmbeddedFile> ready_scenes();

}  // namespace splatscope
