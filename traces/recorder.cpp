#include "traces/recorder.h"

#include <algorithm>

#include "model/error.h"
#include "traces/gamma.h"
#include "traces/hierarchy/block_trace.h"
#include "traces/splat_trace.h"

namespace splatscope::traces {
namespace {

SplatPass pass_of(const Splatting& splatting) {
  const bool per_pixel = splatting.algorithm == Algorithm::ewa_per_pixel;
  return {.prefilter = splatting.algorithm != Algorithm::no_ewa,
          .sum_weights = per_pixel,
          .normalize_on_host = per_pixel,
          .refine = splatting.refine};
}

// The weights that an algorithm splats with. Per pixel, the sum of the weights must not saturate: gamma keeps
// it under 1, and the division takes it out again.
CapturedWeights weights_of(std::span<const Surfel> surfels, const Scene& scene, const Splatting& splatting,
                           const NumberFormats& formats, const std::function<void(double)>& progress) {
  if (scene.splatting.algorithm != Algorithm::ewa_per_pixel)
    return capture_weights(surfels, splatting, scene.capture, formats, progress);
  return uniform_weights(surfels.size(), splatting.gamma);
}

// The LDC tree of a scene, and what its camera needs of it.
struct Blocks {
  LdcTree tree;
  std::vector<ChosenFrame> frames;
  std::vector<std::vector<VertexWeights>> weights;  // by level, in the tree's order
  std::vector<double> gammas;                       // by level

  explicit Blocks(const Scene& scene)
      : tree(build_ldc_tree(scene.surfels, scene.hierarchy.block_surfels)),
        frames(choose_blocks(tree, view_of(scene.camera, scene.frame), scene.splatting, scene.hierarchy)),
        weights(tree.levels.size()),
        gammas(tree.levels.size(), scene.splatting.gamma) {}

  // Given in the scene's order.
  void set_finest(std::span<const VertexWeights> given) {
    weights.front().reserve(given.size());
    for (const std::uint32_t surfel : tree.order) weights.front().push_back(given[surfel]);
  }
};

void record_all(const Scene& scene, std::span<const VertexWeights> weights, Recording& out) {
  out.counts.scene_surfels = out.counts.surfels = scene.surfels.size();
  out.trace = splat_trace({scene.surfels, weights, scene.splatting.gamma}, view_of(scene.camera, scene.frame),
                          scene.splatting, pass_of(scene.splatting));
}

void record_blocks(const Scene& scene, const Blocks& blocks, Recording& out) {
  out.trace = block_trace(blocks.tree, blocks.frames, blocks.weights, blocks.gammas,
                          view_of(scene.camera, scene.frame), scene.splatting, pass_of(scene.splatting));
  out.counts.blocks = blocks.frames.back().counts;
  out.counts.scene_surfels = scene.surfels.size();
  out.counts.surfels = out.counts.blocks.surfels;
}

void count(const CapturedWeights& captured, const Scene& scene, RecordCounts& counts) {
  if (scene.splatting.algorithm == Algorithm::ewa_per_pixel) return;
  counts.weights_captured += captured.captured;
  counts.weights_at_edges += captured.at_edges;
  counts.weights_by_default += captured.unseen;
  counts.weights_outside_box += captured.outside_box;
}

}  // namespace

Recording record(const Scene& scene, const CapturedWeights& captured) {
  Recording out;
  count(captured, scene, out.counts);
  if (scene.hierarchy.culling == Culling::none) {
    record_all(scene, captured.weights, out);
  } else {
    Blocks blocks(scene);
    for (const std::size_t level : levels_of(blocks.frames)) {
      if (level != 0)
        throw ModelError("a scene with coarser levels is recorded with the finest one's weights");
      blocks.set_finest(captured.weights);
    }
    record_blocks(scene, blocks, out);
  }
  return out;
}

Recording record(const Scene& scene, const NumberFormats& formats,
                 const std::function<void(double)>& progress) {
  if (scene.hierarchy.culling == Culling::none)
    return record(scene, weights_of(scene.surfels, scene, scene.splatting, formats, progress));
  Recording out;
  Blocks blocks(scene);
  const std::vector<std::size_t> levels = levels_of(blocks.frames);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto step = [&](double fraction) {
      if (progress) progress((static_cast<double>(i) + fraction) / static_cast<double>(levels.size()));
    };
    const std::size_t level = levels[i];
    Splatting splatting = level_splatting(scene.splatting, level);
    const std::span<const Surfel> surfels = level == 0 ? scene.surfels : blocks.tree.levels[level].surfels;
    if (level != 0) splatting.gamma = std::min(splatting.gamma, suitable_gamma(surfels, splatting));
    blocks.gammas[level] = splatting.gamma;
    CapturedWeights captured = weights_of(surfels, scene, splatting, formats, step);
    count(captured, scene, out.counts);
    if (level == 0) {
      blocks.set_finest(captured.weights);
    } else {
      blocks.weights[level] = std::move(captured.weights);
    }
  }
  record_blocks(scene, blocks, out);
  return out;
}

}  // namespace splatscope::traces
