#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/isa/opcode.h"
#include "model/isa/program.h"
#include "model/vertex/vertex_program.h"

// A vs_1_1 program as the executors see it: macros expanded, relative addresses made explicit, registers as
// places in a workspace. Internal to model/vertex.
namespace splatscope::vertex {

enum class Operation : std::uint8_t {
  move,
  add,
  multiply,
  multiply_add,
  dot3,
  dot4,
  minimum,
  maximum,
  less,
  greater_equal,
  reciprocal,
  reciprocal_sqrt,
  expp,
  logp,
  lit,
  distance,
  exponent,
  logarithm,
  fraction,
  load_address,     // a0.x of each vertex from source 0, x
  gather_constant,  // c[a0.x + constant_offset] into the scratch register
  spread            // a register with a lane a group into that with a lane a vertex (groups.h)
};

// A register's place: which array of the workspace, and its index there.
enum class Place : std::uint8_t { temporary, input, constant, scratch, output, address };

struct StepSource {
  Place place = Place::temporary;
  std::uint16_t index = 0;
  std::array<std::uint8_t, 4> swizzle{0, 1, 2, 3};
  bool negate = false;
};

struct Step {
  Operation operation = Operation::move;
  Place destination_place = Place::temporary;
  std::uint16_t destination_index = 0;
  std::uint8_t mask = 0xf;
  std::uint16_t constant_offset = 0;  // of gather_constant
  std::uint8_t source_count = 0;
  std::array<StepSource, 3> sources;
  std::uint32_t instruction = 0;  // its place in the program
};

std::vector<Step> make_steps(const isa::Program& program);

inline constexpr int kBroadcast = 16;  // floats of the widest SIMD register

// Which registers may hold an INF, a NaN or a denormal in some lane, as far as the nv20 code has to know.
struct SpecialRegisters {
  std::array<bool, isa::kVertexTemporaries> temporaries{};
  std::array<bool, isa::kVertexInputs> inputs{};
  std::array<bool, isa::kVertexConstants> constants{};
  bool scratch = true;
  bool outputs = false;  // written, never read
};

// The registers of one batch while it runs.
struct Workspace {
  SpecialRegisters special;
  alignas(64) float temporaries[isa::kVertexTemporaries][4][kBatch];
  alignas(64) float scratch[4][kBatch];
  alignas(64) float broadcast[isa::kVertexConstants][4][kBroadcast];  // constants, once a SIMD lane
  alignas(64) std::int32_t address[kBatch] = {};
  std::array<Vec4, isa::kVertexConstants> constants{};  // those that a draw does not give are 0
};

// A step with its registers found: what the SIMD code runs.
struct Operand {
  std::array<const float*, 4> component{};  // after the swizzle
  std::size_t stride = 1;                   // 0: a constant, the same kBroadcast floats for every vertex
  std::uint32_t sign = 0;                   // 0x80000000 where negated
  const bool* special = nullptr;            // of the register
};

struct Call {
  Operation operation = Operation::move;
  std::size_t component_count = 0;
  std::array<std::uint8_t, 4> components{};  // that are written: the first `component_count`
  float* destination = nullptr;              // [4][kBatch]
  bool* special = nullptr;                   // of the destination
  std::size_t source_count = 0;
  std::array<Operand, 3> sources;

  bool has_special_source() const {
    return std::any_of(sources.begin(), sources.begin() + static_cast<std::ptrdiff_t>(source_count),
                       [](const Operand& source) { return *source.special; });
  }
};

Call resolve(const Step& step, Workspace& workspace, const InputBatch& in, OutputBatch& out);

// load_address and gather_constant, which no SIMD code needs, for vertices 0..count-1, in the default mode.
void run_address_step(const Step& step, Arithmetic arithmetic, Workspace& workspace, const InputBatch& in,
                      int count);

// All four components of one result in the given arithmetic: the scalar reference. Components that do not
// belong to the operation's result are unspecified. Never inlined, also when files are linked as one: callers
// set the processor's mode (processor_mode.h).
[[gnu::noinline]] Vec4 evaluate(Operation operation, Arithmetic arithmetic,
                                const std::array<Vec4, 3>& sources);

// One call for vertices first..last-1 by `evaluate`, in the processor's default mode whatever the mode is.
void run_scalar(const Call& call, Arithmetic arithmetic, int first, int last);

// One call for vertices 0..count-1 (rounded up to whole SIMD registers) on the best SIMD target of this
// machine. nv20: in the mode of Nv20Mode.
void run_simd_ieee(const Call& call, int count);
void run_simd_nv20(const Call& call, int count);

// Whether one of `count` aligned values (a multiple of kBroadcast) is an INF, a NaN or a denormal, or the
// nv20 code does not care.
bool holds_special(const float* values, std::size_t count);

// Whether a value is an INF, a NaN or a denormal.
inline bool is_special(float value) {
  const std::uint32_t magnitude = std::bit_cast<std::uint32_t>(value) & 0x7fffffffu;
  return magnitude != 0 && magnitude - 0x00800000u >= 0x7f000000u;
}

}  // namespace splatscope::vertex
