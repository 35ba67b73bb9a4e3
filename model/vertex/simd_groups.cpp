// Groups of vertices on SIMD registers, compiled once a target and chosen at run time (Highway).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/vertex/simd_groups.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>

#include "model/vertex/groups.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::vertex::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kBroadcast>;

void spread(const float* from, float* to, int count) {
  const auto end = static_cast<std::size_t>(count);
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t i = 0; i < end; ++i) to[i] = from[i / kGroup];
#else
  static_assert(kGroup == 4);
  alignas(64) constexpr std::int32_t kLeaders[kBroadcast] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  const auto leaders = hn::SetTableIndices(F{}, kLeaders);
  for (std::size_t i = 0; i < end; i += hn::Lanes(F{}))
    hn::Store(hn::TableLookupLanes(hn::LoadU(F{}, from + i / kGroup), leaders), F{}, to + i);
#endif
}

template <typename Bytes>
void find_differences(Bytes bytes, const std::uint8_t* buffer, std::uint32_t stride,
                      std::span<const std::uint32_t> vertex_numbers, std::span<std::uint8_t> differences) {
  const std::size_t lanes = hn::Lanes(bytes);
  for (std::size_t next = 0; next < differences.size(); next += lanes) {
    const std::size_t byte = std::min(next, differences.size() - lanes);  // the last ones overlap
    const auto read = [&](std::size_t vertex) HWY_ATTR {
      return hn::LoadU(bytes, buffer + std::size_t{vertex_numbers[vertex]} * stride + byte);
    };
    auto found = hn::Zero(bytes);
    for (std::size_t leader = 0; leader < vertex_numbers.size(); leader += kGroup) {
      const auto first = read(leader);
      for (std::size_t vertex = leader + 1; vertex < leader + kGroup; ++vertex)
        found = hn::Or(found, hn::Xor(first, read(vertex)));
    }
    hn::StoreU(found, bytes, differences.data() + byte);
  }
}

void differences(std::span<const std::byte> buffer, std::uint32_t stride,
                 std::span<const std::uint32_t> vertex_numbers, std::span<std::uint8_t> differences) {
  const hn::CappedTag<std::uint8_t, 32> wide;
  const hn::CappedTag<std::uint8_t, 8> narrow;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(buffer.data());
  if (differences.size() >= hn::Lanes(wide)) {
    find_differences(wide, bytes, stride, vertex_numbers, differences);
  } else if (differences.size() >= hn::Lanes(narrow)) {
    find_differences(narrow, bytes, stride, vertex_numbers, differences);
  } else {
    std::ranges::fill(differences, std::uint8_t{1});  // too little to be worth it
  }
}

}  // namespace splatscope::vertex::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::vertex {
HWY_EXPORT(spread);
HWY_EXPORT(differences);

void spread(const float* from, float* to, int count) {
  HWY_DYNAMIC_DISPATCH(spread)(from, to, count);
}
void find_differences(std::span<const std::byte> buffer, std::uint32_t stride,
                      std::span<const std::uint32_t> vertex_numbers, std::span<std::uint8_t> differences) {
  HWY_DYNAMIC_DISPATCH(differences)(buffer, stride, vertex_numbers, differences);
}
}  // namespace splatscope::vertex
#endif
