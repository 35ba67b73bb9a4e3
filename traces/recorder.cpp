#include "traces/recorder.h"

#include <algorithm>
#include <iterator>
#include <ranges>

#include "kernels/object_space_ewa/programs.h"
#include "traces/splat_trace.h"

namespace splatscope::traces {

namespace {

SplatPass pass_of(Algorithm algorithm) {
  const bool per_pixel = algorithm == Algorithm::ewa_per_pixel;
  return {
      .prefilter = algorithm != Algorithm::no_ewa, .sum_weights = per_pixel, .normalize_on_host = per_pixel};
}

// Appends the last frame once more, normalised per pixel: progressive refinement (Ren 2002, section 8). The
// vertices keep their captured weights: with them the sums stay near gamma, and the division takes out what
// is left.
void refine(Trace& trace) {
  const auto program = static_cast<std::uint32_t>(trace.programs.size());
  trace.programs.push_back(kernels::shader_text(kernels::kWeightedSplatPixelProgram));
  const auto begin = std::ranges::find_if(trace.commands | std::views::reverse, [](const Command& command) {
    return std::holds_alternative<Clear>(command);
  });
  std::vector<Command> frame(std::prev(begin.base()), trace.commands.end());
  trace.commands.emplace_back(Present{});
  for (Command& command : frame) {
    if (auto* draw = std::get_if<Draw>(&command); draw && draw->pixel_program) {
      draw->pixel_program = program;
      draw->state.source_factor = BlendFactor::one;
    }
    trace.commands.push_back(std::move(command));
  }
  trace.commands.emplace_back(NormalizeOnHost{});
}

// Block by block of an LDC tree.
Trace record_blocks(const Scene& scene, std::span<const VertexWeights> weights, RecordCounts& counts) {
  const LdcTree tree = build_ldc_tree(scene.surfels, scene.hierarchy.block_surfels);
  std::vector<VertexWeights> ordered;
  ordered.reserve(tree.order.size());
  for (const std::uint32_t surfel : tree.order) ordered.push_back(weights[surfel]);
  const kernels::View view = view_of(scene.camera, scene.frame);
  std::vector<SurfelBuffer> buffers;
  if (!tree.levels.empty()) buffers = pack(tree.levels.front(), ordered);
  const std::vector<DrawnRange> frame =
      draw_finest(tree, view, scene.splatting, scene.hierarchy.culling, counts.blocks);
  counts.surfels = counts.blocks.surfels;
  return splat_trace(buffers, {&frame, 1}, view, scene.splatting, pass_of(scene.splatting.algorithm));
}

}  // namespace

Recording record(const Scene& scene, const CapturedWeights& captured) {
  Recording out;
  if (scene.hierarchy.culling == Culling::none) {
    out.counts.surfels = scene.surfels.size();
    out.trace = splat_trace({scene.surfels, captured.weights}, view_of(scene.camera, scene.frame),
                            scene.splatting, pass_of(scene.splatting.algorithm));
  } else {
    out.trace = record_blocks(scene, captured.weights, out.counts);
  }
  if (scene.splatting.refine) refine(out.trace);
  if (scene.splatting.algorithm != Algorithm::ewa_per_pixel) {
    out.counts.weights_captured = captured.captured;
    out.counts.weights_at_edges = captured.at_edges;
    out.counts.weights_by_default = captured.unseen;
    out.counts.weights_outside_box = captured.outside_box;
  }
  return out;
}

Recording record(const Scene& scene, const NumberFormats& formats,
                 const std::function<void(double)>& progress) {
  if (scene.splatting.algorithm != Algorithm::ewa_per_pixel) {
    return record(scene, capture_weights(scene.surfels, scene.splatting, scene.capture, formats, progress));
  }
  // The sum of the weights must not saturate: gamma keeps it under 1, and the division takes it out again.
  CapturedWeights equal;
  equal.weights.resize(scene.surfels.size(), equal_weights(scene.splatting.gamma));
  return record(scene, equal);
}

}  // namespace splatscope::traces
