#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/command/commands.h"
#include "model/isa/opcode.h"
#include "model/isa/program.h"
#include "model/number/formats.h"

namespace splatscope::vertex {

inline constexpr int kBatch = 128;  // vertices executed together
inline constexpr int kGroup = 4;    // successive vertices that may have inputs in common

// Output registers in the order of this array: oPos, oD0, oD1, oT0..oT7, oFog (x), oPts (x).
enum Output : int { oPos = 0, oD0 = 1, oD1 = 2, oT0 = 3, oFog = 11, oPts = 12, kOutputs = 13 };

// The place of a register there; nothing for one that is no output.
std::optional<int> output_of(isa::RegisterFile file, int index);

// Registers of a batch, structure of arrays: [register][component][vertex].
struct InputBatch {
  alignas(64) float v[isa::kVertexInputs][4][kBatch];
};
struct OutputBatch {
  alignas(64) float o[kOutputs][4][kBatch];
};

// Vertices of a buffer, `stride` bytes each, that a program is to run on next.
struct NextVertices {
  std::span<const std::byte> buffer;
  std::uint32_t stride = 0;
  std::span<const std::uint32_t> numbers;

  // Begins to bring the bytes of as many as there are of numbers[first] to numbers[first + count - 1].
  void prefetch(std::size_t first, std::size_t count) const;
};

// Registers of one vertex between two instructions.
struct VertexState {
  std::array<Vec4, isa::kVertexTemporaries> temporaries{};
  std::array<Vec4, kOutputs> outputs{};
  int address = 0;  // a0.x
};

// A vs_1_1 program made ready to run on batches of vertices. Every SIMD target gives the bits of the scalar
// code. Outputs: components that the program does not write are 0 (oD0: 1).
class VertexProgram {
 public:
  // Results of RCP and RSQ are rounded to `reciprocal_bits` significant bits, 8 to 24.
  VertexProgram(const isa::Program& program, Arithmetic arithmetic, int reciprocal_bits = 24);
  ~VertexProgram();
  VertexProgram(VertexProgram&&) noexcept;

  unsigned inputs_read() const;  // bit n: v<n>

  // Runs vertices 0..count-1 (count <= kBatch). Constants from c0; those not given are 0; `def` in the
  // program wins.
  void run(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out, int count) const;

  // The program with its constants and the registers of a batch, for batch after batch. It outlives this.
  class Bound {
   public:
    Bound(const VertexProgram& program, std::span<const Vec4> constants);
    ~Bound();

    // What the program reads is to be filled in, up to whole SIMD registers of lanes.
    InputBatch& input();
    // Inputs in which the vertices of each group agree, a lane a group.
    InputBatch& grouped_input();
    const OutputBatch& output() const;
    // Runs vertices 0..count-1 (count <= kBatch) of input(). The inputs in `grouped_inputs` (bit n: v<n>) are
    // taken from grouped_input() instead; `count` is then a multiple of kGroup. The same bits, sooner. The
    // bytes of `next` come from memory meanwhile.
    void run(int count, unsigned grouped_inputs = 0, const NextVertices& next = {});

   private:
    struct State;
    std::unique_ptr<State> state_;
  };

  // The same by the plain scalar interpreter that the SIMD code is checked against.
  void run_scalar(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out, int count) const;

  // Vertex 0 instruction by instruction: its registers before the first one and after each. Only the
  // registers and the components that the program has written by then mean anything.
  std::vector<VertexState> trace(std::span<const Vec4> constants, const InputBatch& in) const;

 private:
  struct Decoded;
  class Execution;
  void run_batch(Execution& execution, int count, unsigned grouped_inputs, const NextVertices& next) const;
  std::unique_ptr<Decoded> decoded_;
};

}  // namespace splatscope::vertex
