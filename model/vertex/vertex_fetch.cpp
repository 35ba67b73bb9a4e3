#include "model/vertex/vertex_fetch.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "model/vertex/groups.h"

namespace splatscope::vertex {
namespace {

constexpr Vec4 kDefault{0, 0, 0, 1};

// `kCount` elements of every vertex, each by `convert`.
template <typename Element, std::size_t kCount, typename Convert>
void gather(const std::byte* first, std::uint32_t stride, std::span<const std::uint32_t> vertex_numbers,
            float (*out)[kBatch], Convert convert) {
  for (std::size_t lane = 0; lane < vertex_numbers.size(); ++lane) {
    const std::byte* const at = first + std::size_t{vertex_numbers[lane]} * stride;
    for (std::size_t c = 0; c < kCount; ++c) {
      Element element;
      std::memcpy(&element, at + c * sizeof element, sizeof element);
      out[c][lane] = convert(element);
    }
  }
}

void fetch(VertexFormat format, const std::byte* first, std::uint32_t stride,
           std::span<const std::uint32_t> vertex_numbers, float (*out)[kBatch]) {
  const auto as_it_is = [](auto element) { return static_cast<float>(element); };
  switch (format) {
    case VertexFormat::float1:
      return gather<float, 1>(first, stride, vertex_numbers, out, as_it_is);
    case VertexFormat::float2:
      return gather<float, 2>(first, stride, vertex_numbers, out, as_it_is);
    case VertexFormat::float3:
      return gather<float, 3>(first, stride, vertex_numbers, out, as_it_is);
    case VertexFormat::float4:
      return gather<float, 4>(first, stride, vertex_numbers, out, as_it_is);
    case VertexFormat::ubyte4:
      return gather<std::uint8_t, 4>(first, stride, vertex_numbers, out, as_it_is);
    case VertexFormat::short2:
      return gather<std::int16_t, 2>(first, stride, vertex_numbers, out, as_it_is);
    case VertexFormat::short4:
      return gather<std::int16_t, 4>(first, stride, vertex_numbers, out, as_it_is);
    case VertexFormat::d3dcolor:
      gather<std::uint8_t, 4>(first, stride, vertex_numbers, out,
                              [](std::uint8_t element) { return static_cast<float>(element) / 255.0f; });
      std::swap_ranges(out[0], out[0] + vertex_numbers.size(), out[2]);
      return;
  }
}

constexpr std::uint32_t kLargestCompared = 256;  // bytes of a vertex

// The inputs in which the vertices of each group agree.
unsigned agreeing_inputs(std::span<const VertexAttribute> attributes, std::span<const std::byte> buffer,
                         std::uint32_t stride, std::span<const std::uint32_t> vertex_numbers) {
  std::uint32_t bytes = 0;
  for (const VertexAttribute& attribute : attributes)
    bytes = std::max(bytes, attribute.offset + size_of(attribute.format));
  if (vertex_numbers.size() % kGroup != 0 || bytes > kLargestCompared) return 0;
  std::array<std::uint8_t, kLargestCompared> differences;
  find_differences(buffer, stride, vertex_numbers, std::span(differences).first(bytes));
  unsigned agreeing = 0xffff;
  for (const VertexAttribute& attribute : attributes) {
    const auto own = std::span(differences).subspan(attribute.offset, size_of(attribute.format));
    if (std::ranges::any_of(own, [](std::uint8_t differs) { return differs != 0; }))
      agreeing &= ~(1u << attribute.input);
  }
  return agreeing;
}

}  // namespace

std::uint32_t size_of(VertexFormat format) {
  switch (format) {
    case VertexFormat::float1:
    case VertexFormat::d3dcolor:
    case VertexFormat::ubyte4:
    case VertexFormat::short2:
      return 4;
    case VertexFormat::float2:
    case VertexFormat::short4:
      return 8;
    case VertexFormat::float3:
      return 12;
    case VertexFormat::float4:
      return 16;
  }
  return 0;
}

void fill_defaults(InputBatch& out, unsigned inputs) {
  for (; inputs != 0; inputs &= inputs - 1)
    for (std::size_t component = 0; component < 4; ++component)
      std::fill_n(out.v[std::countr_zero(inputs)][component], kBatch, kDefault[component]);
}

void fetch(std::span<const VertexAttribute> attributes, std::span<const std::byte> buffer,
           std::uint32_t stride, std::span<const std::uint32_t> vertex_numbers, InputBatch& out) {
  for (const VertexAttribute& attribute : attributes)
    fetch(attribute.format, buffer.data() + attribute.offset, stride, vertex_numbers, out.v[attribute.input]);
}

unsigned fetch_grouped(std::span<const VertexAttribute> attributes, std::span<const std::byte> buffer,
                       std::uint32_t stride, std::span<const std::uint32_t> vertex_numbers, InputBatch& out,
                       InputBatch& grouped) {
  const unsigned agreeing = agreeing_inputs(attributes, buffer, stride, vertex_numbers);
  std::array<std::uint32_t, kBatch / kGroup> leaders;
  const std::size_t groups = agreeing != 0 ? vertex_numbers.size() / kGroup : 0;
  for (std::size_t group = 0; group < groups; ++group) leaders[group] = vertex_numbers[group * kGroup];
  for (const VertexAttribute& attribute : attributes) {
    const bool agrees = (agreeing >> attribute.input & 1u) != 0;
    fetch(attribute.format, buffer.data() + attribute.offset, stride,
          agrees ? std::span<const std::uint32_t>(leaders).first(groups) : vertex_numbers,
          (agrees ? grouped : out).v[attribute.input]);
  }
  return agreeing;
}

}  // namespace splatscope::vertex
