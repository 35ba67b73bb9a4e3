#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "kernels/reference/surfel_filter.h"
#include "kernels/view.h"
#include "model/command/commands.h"

// Every vertex program that can splat, with the vertices that it reads: what Ren 2002, section 8, trades.
namespace splatscope::kernels {

// A corner of a surfel's quad.
struct Corner {
  const Surfel& surfel;
  glm::dvec2 v;   // each 0 or 1
  double radius;  // sqrt(2c) of Eq. 14: where the filter ends, in standard deviations
};

// The corners in the order of a surfel's four vertices; the quad's triangles are 0 1 2 and 0 2 3.
inline constexpr glm::dvec2 kQuadCorners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

// One attribute of a vertex: the register that reads it, how it lies in memory, and what it holds.
struct VertexField {
  std::uint8_t input;
  VertexFormat format;
  glm::dvec4 (*value)(const Corner&);  // as many components as the format has; d3dcolor: r g b a in [0, 1]

  bool operator==(const VertexField&) const = default;
};

// A vertex program, its vertex and its constants.
struct SplatProgram {
  std::string_view name;  // as scene files have it
  std::string_view file;
  std::string_view what;  // a line for people
  std::span<const VertexField> fields;
  // c0, c1, ... `cutoff` is c of Eq. 14, > 0; `depth_offset` is z_t of section 5.1 in camera-space units.
  std::vector<Vec4> (*constants)(const View&, double cutoff, double depth_offset);
  // Its corners lie as the axes of the screen do, x to the right and y up, and not as s and t: corner i is to
  // have the weight of the corner of o +- s +- t that lies there.
  bool screen_corners = false;
  // It adds something of the size of 1 to -1/near: the depth is as exact as floats where near is below 2.
  bool near_in_sums = false;
};

std::span<const SplatProgram> visibility_programs();  // first pass
std::span<const SplatProgram> ewa_programs();         // second pass; the paper's first
const SplatProgram& plain_program();                  // second pass without the prefilter

// One of a pass by its name. Throws ModelError for another name.
const SplatProgram& visibility_program(std::string_view name);
const SplatProgram& ewa_program(std::string_view name);

// Any of them, by its file. Throws ModelError for another file.
const SplatProgram& splat_program(std::string_view file);

int components(VertexFormat format);  // 1 to 4

// Bytes of a vertex, its fields one after the other.
std::uint32_t vertex_bytes(std::span<const VertexField> fields);
std::vector<VertexAttribute> attributes_of(std::span<const VertexField> fields);

// Writes one vertex, vertex_bytes() long.
void write_vertex(std::span<const VertexField> fields, const Corner& corner, std::byte* out);

}  // namespace splatscope::kernels
