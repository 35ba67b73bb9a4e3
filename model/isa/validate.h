#pragma once

#include "model/isa/program.h"

// The rules of each version, by the Direct3D 8.1 reference: registers and their counts, read ports, masks,
// operand rules, uninitialised reads, slots. Programs from text and from tokens are checked alike.
namespace splatscope::isa {

// Throws UserError "name:line:column: rule" for the first rule that the program breaks.
void validate(const Program& program);

// Which components of a source's register an instruction reads (bit 0 = x), after its swizzle.
unsigned components_read(const Instruction& instruction, std::size_t source);

// The same of the register that stands as its destination: texdepth and texkill test it, others read none.
unsigned destination_components_read(Opcode opcode);

}  // namespace splatscope::isa
