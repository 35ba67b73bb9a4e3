#include "traces/volume_sheets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/stop.h"

namespace splatscope::traces {
namespace {

// Of the largest sum, as the machine's contributions are rounded up too.
constexpr double kFill = 0.96;
// Less than this gain is not worth a pass over the sheet.
constexpr int kWorthRescaling = 170;

int pixel(double x, int size) {
  return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size)));
}

// A pixel more: the machine's corners differ by its rounding.
Rectangle rectangle_of(const HostVoxel& voxel, const kernels::View& view) {
  return {pixel(std::floor(voxel.low.x) - 1, view.width), pixel(std::floor(voxel.low.y) - 1, view.height),
          pixel(std::ceil(voxel.high.x) + 1, view.width), pixel(std::ceil(voxel.high.y) + 1, view.height)};
}

// The opacities of a sheet before they are blended, in software.
class SheetSums {
 public:
  SheetSums(const Rectangle& rectangle, double cutoff)
      : rectangle_(rectangle),
        cutoff_(static_cast<float>(cutoff)),
        sums_(static_cast<std::size_t>(rectangle.right - rectangle.left) *
              static_cast<std::size_t>(rectangle.bottom - rectangle.top)) {}

  void add(const HostVoxel& voxel, const Rectangle& within) {
    const glm::vec2 center = 0.5f * (voxel.low + voxel.high);
    for (int y = within.top; y < within.bottom; ++y) {
      stop_if_asked();
      const float dy = static_cast<float>(y) + 0.5f - center.y;
      float* row = &sums_[static_cast<std::size_t>(y - rectangle_.top) *
                          static_cast<std::size_t>(rectangle_.right - rectangle_.left)];
      for (int x = within.left; x < within.right; ++x) {
        const float dx = static_cast<float>(x) + 0.5f - center.x;
        const float r = voxel.conic.x * dx * dx + voxel.conic.y * dx * dy + voxel.conic.z * dy * dy;
        if (r < cutoff_) row[x - rectangle_.left] += voxel.opacity * std::exp(-0.5f * r);
      }
    }
  }

  double most() const { return static_cast<double>(*std::ranges::max_element(sums_)); }

 private:
  Rectangle rectangle_;
  float cutoff_;
  std::vector<float> sums_;
};

// The whole number of 1/255 by which `most` comes to kFill at the least.
int steps_for(double most) {
  return static_cast<int>(std::clamp(std::ceil(255 * most / kFill), 1.0, 255.0));
}

// `most`: the largest sum of a level and the fainter ones.
void choose_gains(const std::array<double, kVoxelLevels>& most, SheetPlan& plan) {
  plan.composite = steps_for(most[0]);
  plan.gain[0] = 255.0 / plan.composite;
  for (std::size_t level = 1; level < kVoxelLevels; ++level) {
    int& rescale = plan.rescale[level - 1];
    if (most[level] > 0) rescale = steps_for(plan.gain[level - 1] * most[level]);
    if (rescale > kWorthRescaling) rescale = 255;
    plan.gain[level] = plan.gain[level - 1] * 255 / rescale;
  }
}

}  // namespace

std::size_t SheetPlanner::level_of(double weight) const {
  std::size_t level = 0;
  while (level + 1 < kVoxelLevels && weight <= weight_of(level + 1)) ++level;
  return level;
}

double SheetPlanner::weight_of(std::size_t level) const {
  return heaviest * std::pow(kVoxelLevelRatio, static_cast<double>(level));
}

SheetPlan SheetPlanner::plan(std::span<const HostVoxel> voxels,
                             std::span<const std::uint32_t> numbers) const {
  SheetPlan plan;
  plan.gain.fill(1);
  plan.rescale.fill(255);
  Rectangle& whole = plan.rectangle;
  whole = {std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), 0, 0};
  for (const std::uint32_t k : numbers) {
    stop_if_asked();
    const HostVoxel& voxel = voxels[k];
    if (!voxel.drawn) continue;
    const Rectangle r = rectangle_of(voxel, view);
    whole = {std::min(whole.left, r.left), std::min(whole.top, r.top), std::max(whole.right, r.right),
             std::max(whole.bottom, r.bottom)};
    const double weight = static_cast<double>(voxel.weight);
    const std::size_t level = level_of(weight);
    plan.voxels[level][shared && !voxel.flat ? kSharedVariance : kOwnVariance].push_back(k);
    plan.opacity[level] = std::max(plan.opacity[level], static_cast<double>(voxel.opacity));
  }
  if (!gains || whole.empty()) return plan;
  SheetSums sums(whole, cutoff);
  std::array<double, kVoxelLevels> most{};
  for (std::size_t level = kVoxelLevels; level-- > 0;) {
    for (const auto& kind : plan.voxels[level]) {
      for (const std::uint32_t k : kind) sums.add(voxels[k], rectangle_of(voxels[k], view));
    }
    most[level] = sums.most();
  }
  choose_gains(most, plan);
  return plan;
}

}  // namespace splatscope::traces
