#pragma once

#include "model/command/commands.h"
#include "model/isa/program.h"

namespace splatscope {

// Throws UserError, which names the shader, where it does not assemble or is not valid.
inline isa::Program load_program(const ShaderText& shader) {
  return isa::load(shader.text, shader.name);
}

}  // namespace splatscope
