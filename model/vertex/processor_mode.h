#pragma once

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

// The processor's floating-point mode, for as long as one of these lives. A function that sets a mode does no
// arithmetic itself: the compiler may move that across the change.
namespace splatscope::vertex {

#if defined(__x86_64__)
class ProcessorMode {
 public:
  explicit ProcessorMode(unsigned mode) : saved_(_mm_getcsr()) { _mm_setcsr(mode); }
  ~ProcessorMode() { _mm_setcsr(saved_); }
  ProcessorMode(const ProcessorMode&) = delete;
  ProcessorMode& operator=(const ProcessorMode&) = delete;

 private:
  unsigned saved_;
};

// Exceptions masked; nearest, with denormals.
struct DefaultMode : ProcessorMode {
  DefaultMode() : ProcessorMode(0x1f80) {}
};
// The NV20's rounding: toward zero, denormal results and operands are zeros.
struct Nv20Mode : ProcessorMode {
  Nv20Mode() : ProcessorMode(0x1f80 | 0x6000 | 0x8000 | 0x0040) {}
};
#else
struct DefaultMode {
  DefaultMode() {}
};
struct Nv20Mode {
  Nv20Mode() {}
};
#endif

}  // namespace splatscope::vertex
