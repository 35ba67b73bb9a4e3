#include "model/vertex/vertex_fetch.h"

#include <algorithm>
#include <cstring>

namespace splatscope::vertex {
namespace {

constexpr Vec4 kDefault{0, 0, 0, 1};

template <typename T>
void expand(const std::byte* bytes, std::size_t count, Vec4& value) {
  for (std::size_t i = 0; i < count; ++i) {
    T element;
    std::memcpy(&element, bytes + i * sizeof(T), sizeof(T));
    value[i] = static_cast<float>(element);
  }
}

Vec4 expand(VertexFormat format, const std::byte* bytes) {
  Vec4 value = kDefault;
  switch (format) {
    case VertexFormat::float1:
      expand<float>(bytes, 1, value);
      break;
    case VertexFormat::float2:
      expand<float>(bytes, 2, value);
      break;
    case VertexFormat::float3:
      expand<float>(bytes, 3, value);
      break;
    case VertexFormat::float4:
      expand<float>(bytes, 4, value);
      break;
    case VertexFormat::ubyte4:
      expand<std::uint8_t>(bytes, 4, value);
      break;
    case VertexFormat::short2:
      expand<std::int16_t>(bytes, 2, value);
      break;
    case VertexFormat::short4:
      expand<std::int16_t>(bytes, 4, value);
      break;
    case VertexFormat::d3dcolor:
      expand<std::uint8_t>(bytes, 4, value);
      std::swap(value[0], value[2]);
      for (float& component : value) component /= 255.0f;
      break;
  }
  return value;
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

void fetch(std::span<const VertexAttribute> attributes, std::span<const std::byte> buffer,
           std::uint32_t stride, std::span<const std::uint32_t> vertex_numbers, InputBatch& out) {
  const auto count = vertex_numbers.size();
  for (auto& input : out.v)
    for (std::size_t component = 0; component < 4; ++component)
      std::fill_n(input[component], count, kDefault[component]);
  for (const VertexAttribute& attribute : attributes) {
    for (std::size_t lane = 0; lane < count; ++lane) {
      const std::size_t offset = std::size_t{vertex_numbers[lane]} * stride + attribute.offset;
      const Vec4 value = expand(attribute.format, buffer.data() + offset);
      for (std::size_t component = 0; component < 4; ++component)
        out.v[attribute.input][component][lane] = value[component];
    }
  }
}

}  // namespace splatscope::vertex
