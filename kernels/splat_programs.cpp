#include "kernels/splat_programs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numbers>

#include "kernels/object_space_ewa/programs.h"
#include "kernels/short_ewa/programs.h"
#include "model/error.h"
#include "model/vertex/vertex_fetch.h"

namespace splatscope::kernels {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

// What a field can hold. Normals point where s x t does.
dvec3 normal(const Corner& c) {
  return glm::normalize(glm::cross(c.surfel.tangent_s, c.surfel.tangent_t));
}
double deviation(const Corner& c) {  // of the reconstruction filter, object units
  return c.surfel.sigma * glm::length(c.surfel.tangent_s);
}
dvec2 y(const Corner& c) {
  return c.radius * (2.0 * c.v - 1.0);
}

dvec4 position(const Corner& c) {
  return {c.surfel.position, 1};
}
dvec4 tangent_s(const Corner& c) {
  return {c.surfel.tangent_s, 0};
}
dvec4 tangent_t(const Corner& c) {
  return {c.surfel.tangent_t, 0};
}
dvec4 corner(const Corner& c) {
  return {c.v, 0, 0};
}
dvec4 filter(const Corner& c) {
  return {c.surfel.sigma, c.surfel.weight, 0, 0};
}
dvec4 color(const Corner& c) {
  return {c.surfel.color, 1};
}
dvec4 quad_corner(const Corner& c) {
  const dvec2 u = 2.0 * c.v - 1.0;
  return {c.surfel.position + u.x * c.surfel.tangent_s + u.y * c.surfel.tangent_t, 1};
}
dvec4 plane(const Corner& c) {  // the plane's distance belongs to the normal as the vertex holds it
  const dvec3 n(glm::vec3(normal(c)));
  return {n, -glm::dot(n, c.surfel.position)};
}
dvec4 scaled_y(const Corner& c) {
  return {deviation(c) * y(c), 0, 0};
}
dvec4 inverse_variance(const Corner& c) {
  return {1 / (deviation(c) * deviation(c)), 0, 0, 0};
}
double height(const Corner& c) {  // s_k/(2 pi sigma^2)
  return 0.5 * std::numbers::inv_pi * c.surfel.weight / (c.surfel.sigma * c.surfel.sigma);
}
dvec4 weighted_color(const Corner& c) {
  return {c.surfel.color, height(c)};
}
dvec4 unit_normal(const Corner& c) {
  return {normal(c), 0};
}
dvec4 deviation_and_height(const Corner& c) {
  return {deviation(c), height(c), 0, 0};
}

using enum VertexFormat;

// 56 bytes: what the paper describes.
constexpr VertexField kPaperVertex[] = {
    {kPositionInput, float3, position},  {kTangentSInput, float3, tangent_s},
    {kTangentTInput, float3, tangent_t}, {kCornerInput, float2, corner},
    {kFilterInput, float2, filter},      {kColorInput, d3dcolor, color}};

constexpr VertexField kCornerVertex[] = {{kPositionInput, float3, quad_corner}};

constexpr VertexField kPlaneVertex[] = {{kPositionInput, float3, position},
                                        {kPlaneInput, float4, plane},
                                        {kScaledCornerInput, float2, scaled_y},
                                        {kInverseVarianceInput, float1, inverse_variance},
                                        {kWeightedColorInput, float4, weighted_color},
                                        {kTextureInput, short2, corner}};

constexpr VertexField kNormalVertex[] = {{kPositionInput, float3, position},
                                         {kNormalInput, float3, unit_normal},
                                         {kShortCornerInput, short2, corner},
                                         {kDeviationInput, float2, deviation_and_height},
                                         {kColorInput, d3dcolor, color}};

constexpr SplatProgram kVisibility[] = {
    {"quad", kVisibilityProgram, "makes its corner from o, s and t", kPaperVertex, splat_constants},
    {"corner", kCornerVisibilityProgram, "finds its corner in the vertex", kCornerVertex, splat_constants}};

constexpr SplatProgram kEwa[] = {
    {"paper", kEwaProgram, "the paper's: eigenvalues of M by Appendix A", kPaperVertex, splat_constants},
    {"normal", kNormalProgram, "the same factor as plane, from the least bytes", kNormalVertex,
     plane_constants, true, true},
    {"plane", kPlaneProgram, "Cholesky factor on the screen, the surfel's plane by its normal", kPlaneVertex,
     plane_constants, true, true},
    {"facing", kFacingProgram, "the same for surfels that face the eye; the others vanish", kPlaneVertex,
     plane_constants, true, true}};

constexpr SplatProgram kPlain = {"plain", kPlainProgram, "the reconstruction filter alone", kPaperVertex,
                                 splat_constants};

// Rounds to nearest, within the type's range.
template <typename T>
T rounded(double value) {
  constexpr double low = std::numeric_limits<T>::min(), high = std::numeric_limits<T>::max();
  return static_cast<T>(std::floor(std::clamp(value, low, high) + 0.5));
}

void write(VertexFormat format, dvec4 value, std::byte* out) {
  const auto store = [&]<typename T>(T (*convert)(double)) {
    for (int i = 0; i < components(format); ++i) {
      const T element = convert(value[i]);
      std::memcpy(out + static_cast<std::size_t>(i) * sizeof element, &element, sizeof element);
    }
  };
  switch (format) {
    case short2:
    case short4:
      return store(rounded<std::int16_t>);
    case ubyte4:
      return store(rounded<std::uint8_t>);
    case d3dcolor:
      value = 255.0 * dvec4(value.b, value.g, value.r, value.a);
      return store(rounded<std::uint8_t>);
    default:
      return store(+[](double element) { return static_cast<float>(element); });
  }
}

const SplatProgram& named(std::span<const SplatProgram> programs, std::string_view name) {
  const auto found = std::ranges::find(programs, name, &SplatProgram::name);
  if (found == programs.end()) throw ModelError(fmt::format("no program of this pass is named {}", name));
  return *found;
}

}  // namespace

std::span<const SplatProgram> visibility_programs() {
  return kVisibility;
}
std::span<const SplatProgram> ewa_programs() {
  return kEwa;
}
const SplatProgram& plain_program() {
  return kPlain;
}

const SplatProgram& visibility_program(std::string_view name) {
  return named(kVisibility, name);
}
const SplatProgram& ewa_program(std::string_view name) {
  return named(kEwa, name);
}

const SplatProgram& splat_program(std::string_view file) {
  for (const std::span<const SplatProgram> programs : {visibility_programs(), ewa_programs()}) {
    const auto found = std::ranges::find(programs, file, &SplatProgram::file);
    if (found != programs.end()) return *found;
  }
  if (file != kPlain.file) throw ModelError(fmt::format("{} is no program that splats", file));
  return kPlain;
}

int components(VertexFormat format) {
  switch (format) {
    case VertexFormat::float1:
      return 1;
    case VertexFormat::float2:
    case VertexFormat::short2:
      return 2;
    case VertexFormat::float3:
      return 3;
    default:
      return 4;
  }
}

std::uint32_t vertex_bytes(std::span<const VertexField> fields) {
  std::uint32_t bytes = 0;
  for (const VertexField& field : fields) bytes += vertex::size_of(field.format);
  return bytes;
}

std::vector<VertexAttribute> attributes_of(std::span<const VertexField> fields) {
  std::vector<VertexAttribute> attributes;
  std::uint32_t offset = 0;
  for (const VertexField& field : fields) {
    attributes.push_back({field.input, field.format, static_cast<std::uint16_t>(offset)});
    offset += vertex::size_of(field.format);
  }
  return attributes;
}

void write_vertex(std::span<const VertexField> fields, const Corner& corner, std::byte* out) {
  for (const VertexField& field : fields) {
    write(field.format, field.value(corner), out);
    out += vertex::size_of(field.format);
  }
}

}  // namespace splatscope::kernels
