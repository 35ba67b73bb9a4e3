#include "model/vertex/vertex_fetch.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>
#include <numeric>
#include <vector>

#include "model/testing/simd_targets.h"

namespace splatscope::vertex {
namespace {

// The second of two vertices of one attribute, at offset 4 of a 24-byte vertex.
template <typename T, std::size_t N>
Vec4 fetched(VertexFormat format, const std::array<T, N>& elements) {
  std::vector<std::byte> buffer(2 * 24, std::byte{0xee});
  std::memcpy(buffer.data() + 24 + 4, elements.data(), sizeof(elements));
  EXPECT_EQ(size_of(format), sizeof(elements));
  const VertexAttribute attribute{3, format, 4};
  const std::uint32_t number = 1;
  const auto batch = std::make_unique<InputBatch>();
  fill_defaults(*batch);
  fetch({&attribute, 1}, buffer, 24, {&number, 1}, *batch);
  const auto& v3 = batch->v[3];
  return {v3[0][0], v3[1][0], v3[2][0], v3[3][0]};
}

TEST(VertexFetch, FloatsAreFilledUpWithZeroZeroZeroOne) {
  EXPECT_EQ(fetched(VertexFormat::float1, std::array{2.5f}), (Vec4{2.5f, 0, 0, 1}));
  EXPECT_EQ(fetched(VertexFormat::float2, std::array{2.5f, -1.0f}), (Vec4{2.5f, -1, 0, 1}));
  EXPECT_EQ(fetched(VertexFormat::float3, std::array{2.5f, -1.0f, 9.0f}), (Vec4{2.5f, -1, 9, 1}));
  EXPECT_EQ(fetched(VertexFormat::float4, std::array{2.5f, -1.0f, 9.0f, 4.0f}), (Vec4{2.5f, -1, 9, 4}));
}

TEST(VertexFetch, IntegersAreConvertedAsTheyAre) {
  EXPECT_EQ(fetched(VertexFormat::ubyte4, std::array<std::uint8_t, 4>{0, 1, 128, 255}),
            (Vec4{0, 1, 128, 255}));
  EXPECT_EQ(fetched(VertexFormat::short2, std::array<std::int16_t, 2>{-32768, 32767}),
            (Vec4{-32768, 32767, 0, 1}));
  EXPECT_EQ(fetched(VertexFormat::short4, std::array<std::int16_t, 4>{1, -2, 3, -4}), (Vec4{1, -2, 3, -4}));
}

TEST(VertexFetch, ColorIsBlueFirstInMemoryAndOver255) {
  const Vec4 color = fetched(VertexFormat::d3dcolor, std::array<std::uint8_t, 4>{10, 20, 255, 51});
  EXPECT_EQ(color, (Vec4{1.0f, 20 / 255.0f, 10 / 255.0f, 51 / 255.0f}));
}

TEST(VertexFetch, InputsWithoutAnAttributeHaveTheDefault) {
  const auto batch = std::make_unique<InputBatch>();
  fill_defaults(*batch);
  for (std::size_t lane = 0; lane < kBatch; ++lane) {
    EXPECT_EQ(batch->v[15][0][lane], 0.0f);
    EXPECT_EQ(batch->v[15][3][lane], 1.0f);
  }
}

// v1 is the same in each group of four vertices of 20 bytes, v2 is not, v3 has no attribute.
TEST(VertexFetch, WhatGroupsAgreeInIsFetchedOnceAGroup) {
  constexpr std::size_t kVertices = 12;
  std::vector<float> buffer;
  for (std::size_t vertex = 0; vertex < kVertices; ++vertex)
    for (std::size_t word = 0; word < 5; ++word)
      buffer.push_back(static_cast<float>(word < 3 ? vertex / kGroup : vertex));
  const VertexAttribute attributes[] = {{1, VertexFormat::float3, 0}, {2, VertexFormat::float2, 12}};
  std::vector<std::uint32_t> numbers(kVertices);
  std::iota(numbers.begin(), numbers.end(), 0u);
  const auto each = std::make_unique<InputBatch>(), grouped = std::make_unique<InputBatch>();
  const auto fetch_them = [&] {
    return fetch_grouped(attributes, std::as_bytes(std::span(buffer)), 20, numbers, *each, *grouped);
  };
  testing::on_each_simd_target([&] {
    EXPECT_EQ(fetch_them(), 0xffffu & ~0b100u);
    for (std::size_t lane = 0; lane < kVertices; ++lane) {
      EXPECT_EQ(each->v[2][1][lane], static_cast<float>(lane));
      EXPECT_EQ(grouped->v[1][2][lane / kGroup], static_cast<float>(lane / kGroup));
    }
  });
  buffer[5 * (kVertices - 1) + 2] += 1;  // the last vertex, the last word of v1
  testing::on_each_simd_target([&] {
    EXPECT_EQ(fetch_them(), 0xffffu & ~0b110u);
    EXPECT_EQ(each->v[1][2][kVertices - 1], 3.0f);
  });
  numbers.pop_back();  // no whole groups
  EXPECT_EQ(fetch_them(), 0u);
}

}  // namespace
}  // namespace splatscope::vertex
