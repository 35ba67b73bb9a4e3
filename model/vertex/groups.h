#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/vertex/steps.h"

// Work that the vertices of a group have in common. The four corners of a surfel are successive vertices that
// differ in one input, the corner, so that most of what a program computes is the same for all of them. It is
// then computed once, on one lane a group. Internal to model/vertex.
namespace splatscope::vertex {

// The components of a source, before its swizzle, that a step reads at most (bit 0: x).
unsigned components_read(const Step& step, const StepSource& source);

struct PlannedStep {
  Step step;
  bool grouped = false;  // on registers with a lane a group; else a lane a vertex
};

// `steps` for batches in which the vertices of each group agree in `grouped_inputs` (bit n: v<n>): a step
// that reads nothing else is grouped, and before a step that is not come those that spread what it reads of
// the others. In the end every output is spread.
std::vector<PlannedStep> plan_groups(const std::vector<Step>& steps, unsigned grouped_inputs);

// to[i] = from[i / kGroup] for `count` vertices, rounded up to whole SIMD registers. Both arrays are
// [kBatch], `to` is aligned.
void spread(const float* from, float* to, int count);

// The bytes of a vertex in which the vertices of a group differ, of all groups of `vertex_numbers` together:
// differences[i] is 0 where they agree in byte i. Reads as many bytes of each vertex, `stride` apart.
void find_differences(std::span<const std::byte> buffer, std::uint32_t stride,
                      std::span<const std::uint32_t> vertex_numbers, std::span<std::uint8_t> differences);

}  // namespace splatscope::vertex
