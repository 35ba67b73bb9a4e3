#pragma once

#include <span>
#include <string_view>

#include "traces/models/mesh.h"

// Solid patterns: colour as a function of the place in space, of high frequency, as the models of Ren 2002
// have.
namespace splatscope::traces {

// own: what the model has itself.
enum class Pattern { own, plain, checker, stripes, zebra, marble, spots, scales };

// Their names in the order of the enumeration.
std::span<const std::string_view> pattern_names();

// Whether it has squares, stripes or spots, which have a size.
bool has_scale(Pattern pattern);

// `position` in units of the pattern: a square, stripe, spot or scale is about 1 across. Not for `own`.
glm::vec3 pattern_color(Pattern pattern, const glm::dvec3& position);

// The same in the given colours.
glm::vec3 pattern_color(Pattern pattern, const glm::dvec3& position, const glm::vec3& light,
                        const glm::vec3& dark);

// Band-limited noise in [-1, 1], features about 1 across.
double noise(const glm::dvec3& position);

}  // namespace splatscope::traces
