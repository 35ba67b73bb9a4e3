#pragma once

#include <cstdint>
#include <vector>

#include "model/command/commands.h"

namespace splatscope::llvmpipe {

// A trace on Mesa's software renderer, off screen. Buffers, textures and programs are made once; draw() runs
// the commands of one frame and waits until it is done. For traces of splatting: programs that glsl.h knows,
// one texture, and blending SRC_ALPHA, ONE.
class GlRenderer {
 public:
  // Throws ModelError where there is no such renderer.
  explicit GlRenderer(const Trace& trace);

  void draw() const;
  // r g b a of each pixel, rows from the top.
  std::vector<std::uint8_t> read() const;
  // "llvmpipe (LLVM 15.0.6, 256 bits)"
  const char* name() const;

 private:
  void run(const Clear& clear) const;
  void run(const Draw& draw) const;
  void run(const NormalizeOnHost&) const;
  void run(const Present&) const {}

  const Trace& trace_;
  std::vector<unsigned> buffers_, textures_;
  std::vector<unsigned> programs_;  // by vertex program
};

}  // namespace splatscope::llvmpipe
