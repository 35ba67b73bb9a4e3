#include <fmt/format.h>

#include "model/isa/opcode.h"
#include "model/isa/register_names.h"
#include "model/isa/rules.h"
#include "model/isa/validate.h"

namespace splatscope::isa {

void validate_pixel(const Program& program) {
  bool r0_written = false;
  for (const Instruction& instruction : program.instructions) {
    check_read_ports(program, instruction, RegisterFile::constant, 2);
    r0_written |=
        instruction.destination.file == RegisterFile::temporary && instruction.destination.index == 0;
  }
  if (!r0_written) reject(program, program.instructions.back(), "r0 is not written: it is the result");
}

}  // namespace splatscope::isa
