#pragma once

#include <cstdlib>
#include <memory>

#include "model/isa/analysis.h"
#include "model/isa/tokens.h"
#include "model/isa/validate.h"
#include "model/pixel/pixel_program.h"
#include "model/vertex/vertex_program.h"

// What the fuzzers of the assembler and of the token reader ask of any program that they get through.
namespace splatscope::isa {

// Aborts where the condition does not hold: libFuzzer then keeps the input.
inline void require(bool condition) {
  if (!condition) std::abort();
}

// Text and tokens end where they began; what is valid can be analysed and run. Throws UserError where it is
// not valid.
inline void exercise(const Program& program) {
  const auto tokens = write_tokens(program);
  const std::string text = disassemble(read_tokens(tokens, "tokens"));
  require(write_tokens(assemble(text, "text")) == tokens);
  validate(program);
  require(analyze(program).instructions.size() == program.instructions.size());
  if (program.version.kind == ShaderKind::vertex) {
    const auto in = std::make_unique<vertex::InputBatch>();
    const auto out = std::make_unique<vertex::OutputBatch>();
    for (const Arithmetic arithmetic : {Arithmetic::ieee, Arithmetic::nv20})
      vertex::VertexProgram(program, arithmetic).run({}, *in, *out, 1);
  } else {
    const auto batch = std::make_unique<pixel::FragmentBatch>();
    pixel::PixelProgram(program).run({}, *batch, 1, [](int, const pixel::Lanes*, pixel::Lanes* texel, int) {
      for (std::size_t c = 0; c < 4; ++c) texel[c][0] = 0.5f;
    });
  }
}

}  // namespace splatscope::isa
