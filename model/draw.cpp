#include "model/draw.h"

#include <bit>
#include <cstring>

#include "model/output/output.h"
#include "model/vertex/vertex_fetch.h"

namespace splatscope {
namespace {

constexpr int kCorners = 3;

// One triangle waiting for its vertices: where each corner stands in the order of shading.
struct PendingTriangle {
  std::array<std::uint32_t, kCorners> sequence;
};

// The post-transform FIFO and the shading of what misses it, a batch at a time.
class VertexStage {
 public:
  VertexStage(const DrawBindings& bindings, int cache_entries)
      : bindings_(bindings),
        cache_entries_(static_cast<std::uint32_t>(cache_entries)),
        inserted_(bindings.vertices.bytes.size() / bindings.draw.vertex_stride, 0),
        ring_(std::bit_ceil(static_cast<std::size_t>(vertex::kBatch + cache_entries + kCorners))) {}

  bool full() const { return batch_.size() + kCorners > vertex::kBatch; }
  std::span<const std::uint32_t> batch() const { return batch_; }

  // The place of a vertex in the order of shading; `fresh` counts up where it is not in the FIFO and joins
  // the batch.
  std::uint32_t find_or_add(std::uint32_t vertex_number, std::uint8_t& fresh) {
    std::uint32_t& inserted = inserted_[vertex_number];  // 0: never, else 1 + its place
    if (inserted != 0 && next_ - (inserted - 1) <= cache_entries_) return inserted - 1;
    ++fresh;
    batch_.push_back(vertex_number);
    inserted = ++next_;
    return next_ - 1;
  }

  void shade_batch() {
    vertex::fetch(bindings_.draw.attributes, bindings_.vertices.bytes, bindings_.draw.vertex_stride, batch_,
                  input_);
    bindings_.vertex.run(bindings_.draw.constants, input_, output_, static_cast<int>(batch_.size()));
    const std::uint32_t first = next_ - static_cast<std::uint32_t>(batch_.size());
    for (std::uint32_t i = 0; i < batch_.size(); ++i) store(first + i, i);
    batch_.clear();
  }

  const primitive::ClipVertex& operator[](std::uint32_t sequence) const {
    return ring_[sequence & (ring_.size() - 1)];
  }

 private:
  void store(std::uint32_t sequence, std::uint32_t lane) {
    primitive::ClipVertex& vertex = ring_[sequence & (ring_.size() - 1)];
    for (int c = 0; c < 4; ++c) vertex.position[c] = output_.o[vertex::oPos][c][lane];
    for (const int attribute : bindings_.attributes) {
      const int output = vertex::oD0 + attribute;  // both orders are D0, D1, T0, T1, ...
      for (int c = 0; c < 4; ++c) {
        const float value = output_.o[output][c][lane];
        const bool color = attribute <= primitive::kSpecular;  // saturated on the way out of the vertex unit
        vertex.attributes[attribute][c] = color ? output::saturate(value) : value;
      }
    }
  }

  const DrawBindings& bindings_;
  std::uint32_t cache_entries_;
  std::vector<std::uint32_t> inserted_;
  std::vector<primitive::ClipVertex> ring_;
  std::vector<std::uint32_t> batch_;
  std::uint32_t next_ = 0;
  vertex::InputBatch input_{};
  vertex::OutputBatch output_{};
};

std::uint32_t index_at(const Buffer& indices, std::uint32_t position) {
  std::uint16_t index;
  std::memcpy(&index, indices.bytes.data() + std::size_t{position} * sizeof index, sizeof index);
  return index;
}

// Everything behind the vertex stage, triangle by triangle.
class TriangleStage {
 public:
  TriangleStage(const DrawBindings& bindings, const RenderOptions& options, Frame& frame, DrawWork& work,
                RenderCounters& counters)
      : bindings_(bindings),
        options_(options),
        frame_(frame),
        work_(work),
        counters_(counters),
        fragments_(bindings, frame),
        viewport_{frame.width, frame.height} {}

  void draw(const primitive::ClipTriangle& triangle, TriangleWork& work) {
    const primitive::Assembled assembled =
        primitive::assemble(triangle, viewport_, bindings_.attributes, pieces_);
    work.outcome = assembled.outcome;
    const int kept = drop_culled(assembled.pieces);
    if (kept == 0 && assembled.pieces != 0) work.outcome = TriangleOutcome::back_facing;
    work.pieces = static_cast<std::uint8_t>(kept);
    for (int piece = 0; piece < kept; ++piece) rasterize(pieces_[piece], work);
    if (work.outcome == TriangleOutcome::drawn && work.quad_count == 0)
      work.outcome = TriangleOutcome::no_coverage;
    count(work);
  }

  void finish() { fragments_.flush(); }

 private:
  // Moves the pieces that face the viewer to the front; returns how many. What decides is the sign on the
  // grid that decides coverage, so a triangle that is dropped and its neighbour that is not never share a
  // pixel.
  int drop_culled(int pieces) {
    const CullMode cull = bindings_.draw.state.cull;
    if (cull == CullMode::none) return pieces;
    const int dropped = cull == CullMode::clockwise ? 1 : -1;
    const int bits = options_.formats.subpixel_bits;
    int kept = 0;
    for (int piece = 0; piece < pieces; ++piece) {
      if (raster::winding(pieces_[piece], bits, raster::driver_rounding(bits)) != dropped) {
        pieces_[kept++] = pieces_[piece];
      }
    }
    return kept;
  }

  void rasterize(const primitive::WindowTriangle& triangle, TriangleWork& work) {
    const raster::TriangleSetup setup =
        raster::set_up(triangle, viewport_, options_.formats.subpixel_bits,
                       raster::driver_rounding(options_.formats.subpixel_bits));
    work.tile_count += raster::tiles_touched(setup);
    raster::for_each_quad(setup, [&](int x, int y, unsigned covered) {
      const unsigned passed = test_depth(setup, x, y, covered);
      int blocks = 0;
      if (!options_.record_work) work_.texel_blocks.clear();
      if (passed != 0 && bindings_.draw.state.color_write) {
        blocks = fragments_.push_quad(setup, triangle, x, y, passed, work_.texel_blocks);
      }
      if (options_.record_work) {
        work_.quads.push_back({static_cast<std::uint16_t>(x / 2), static_cast<std::uint16_t>(y / 2),
                               static_cast<std::uint8_t>(covered), static_cast<std::uint8_t>(passed),
                               static_cast<std::uint8_t>(blocks)});
      }
      ++work.quad_count;
      counters_.fragments += static_cast<unsigned>(std::popcount(covered));
      counters_.fragments_passed += static_cast<unsigned>(std::popcount(passed));
    });
  }

  unsigned test_depth(const raster::TriangleSetup& setup, int x, int y, unsigned covered) {
    const DrawState& state = bindings_.draw.state;
    if (!state.depth_test && !state.depth_write) return covered;
    unsigned passed = 0;
    for (unsigned bit = 0; bit < 4; ++bit) {
      if ((covered >> bit & 1u) == 0) continue;
      const int px = x + static_cast<int>(bit & 1u), py = y + static_cast<int>(bit >> 1);
      const float z = setup.depth.at(static_cast<float>(px - setup.left), static_cast<float>(py - setup.top));
      const std::size_t pixel = static_cast<std::size_t>(py) * frame_.width + static_cast<std::size_t>(px);
      if (output::test_depth(output::quantize_depth(z, frame_.formats.depth), pixel, state, frame_)) {
        passed |= 1u << bit;
      }
    }
    return passed;
  }

  void count(const TriangleWork& work) {
    ++counters_.triangles;
    counters_.quads += work.quad_count;
    counters_.triangles_without_coverage += work.outcome == TriangleOutcome::no_coverage;
    counters_.triangles_outside += work.outcome == TriangleOutcome::outside_frustum;
    counters_.triangles_behind += work.outcome == TriangleOutcome::behind_near;
    counters_.triangles_not_finite += work.outcome == TriangleOutcome::not_finite;
    counters_.triangles_back_facing += work.outcome == TriangleOutcome::back_facing;
    counters_.triangles_clipped += work.pieces > 1;
  }

  const DrawBindings& bindings_;
  const RenderOptions& options_;
  Frame& frame_;
  DrawWork& work_;
  RenderCounters& counters_;
  FragmentPipe fragments_;
  primitive::Viewport viewport_;
  std::array<primitive::WindowTriangle, primitive::kMaxPieces> pieces_;
};

}  // namespace

void render_draw(const DrawBindings& bindings, const RenderOptions& options, Frame& frame, DrawWork& work,
                 RenderCounters& counters) {
  TriangleStage triangle_stage(bindings, options, frame, work, counters);
  VertexStage vertex_stage(bindings, options.vertex_cache_entries);
  std::vector<PendingTriangle> pending;
  std::vector<TriangleWork> pending_work;

  const auto drain = [&] {
    counters.vertices += vertex_stage.batch().size();
    if (options.record_work) {
      work.shaded_vertices.insert(work.shaded_vertices.end(), vertex_stage.batch().begin(),
                                  vertex_stage.batch().end());
    }
    vertex_stage.shade_batch();
    for (std::size_t i = 0; i < pending.size(); ++i) {
      const auto& [a, b, c] = pending[i].sequence;
      triangle_stage.draw({vertex_stage[a], vertex_stage[b], vertex_stage[c]}, pending_work[i]);
    }
    if (options.record_work)
      work.triangles.insert(work.triangles.end(), pending_work.begin(), pending_work.end());
    pending.clear();
    pending_work.clear();
  };

  const Draw& draw = bindings.draw;
  for (std::uint32_t i = 0; i + kCorners <= draw.index_count; i += kCorners) {
    if (vertex_stage.full()) drain();
    PendingTriangle triangle;
    TriangleWork triangle_work;
    for (std::uint32_t corner = 0; corner < kCorners; ++corner) {
      const std::uint32_t vertex =
          draw.base_vertex + index_at(bindings.indices, draw.first_index + i + corner);
      triangle.sequence[corner] = vertex_stage.find_or_add(vertex, triangle_work.new_vertices);
    }
    pending.push_back(triangle);
    pending_work.push_back(triangle_work);
  }
  drain();
  triangle_stage.finish();
}

}  // namespace splatscope
