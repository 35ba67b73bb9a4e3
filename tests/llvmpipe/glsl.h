#pragma once

#include <string>

#include "model/isa/program.h"

namespace splatscope::llvmpipe {

// A vs_1_1 program as a vertex shader of GLSL ES 1.00, instruction by instruction: v# are attributes, c# the
// uniform array c, oD0 and oT0 varyings; the uniform pixel is a pixel of the frame in units of it. Throws
// ModelError where it uses more than splatting does.
std::string vertex_shader(const isa::Program& program);

// splat.ps, and one that writes nothing.
std::string splat_fragment_shader();
std::string empty_fragment_shader();

}  // namespace splatscope::llvmpipe
