#include "model/draw.h"

#include <oneapi/tbb/parallel_pipeline.h>

#include <bit>
#include <memory>

#include "model/fragment_pipe.h"
#include "model/geometry.h"

namespace splatscope {
namespace {

constexpr std::size_t kBatchesInFlight = 4;

// Everything behind the setup, triangle by triangle.
class RasterStage {
 public:
  RasterStage(const DrawBindings& bindings, const RenderOptions& options, Frame& frame, DrawWork& work,
              RenderCounters& counters)
      : state_(bindings.draw.state),
        record_(options.record_work),
        work_(work),
        counters_(counters),
        fragments_(bindings, frame, record_ ? &work : nullptr),
        depth_{frame.depth,
               {frame.width, frame.height},
               frame.formats.depth,
               state_.depth_test,
               state_.depth_write} {}

  void draw(const GeometryBatch& batch) {
    counters_.vertices += batch.shaded_vertices.size();
    if (record_) {
      work_.shaded_vertices.insert(work_.shaded_vertices.end(), batch.shaded_vertices.begin(),
                                   batch.shaded_vertices.end());
    }
    std::size_t piece = 0;
    for (const BatchTriangle& triangle : batch.triangles) {
      draw(triangle, batch, piece);
      piece += triangle.pieces;
    }
    fragments_.end();
  }

  void finish() { fragments_.flush(); }

 private:
  // Whether the draw's cull mode drops a piece. What decides is the sign on the grid that decides coverage,
  // so a triangle that is dropped and its neighbour that is not never share a pixel.
  bool culled(const Piece& piece) const {
    switch (state_.cull) {
      case CullMode::clockwise:
        return piece.setup.winding > 0;
      case CullMode::counter_clockwise:
        return piece.setup.winding < 0;
      case CullMode::none:
        break;
    }
    return false;
  }

  // `first`: of its pieces in the batch.
  void draw(const BatchTriangle& triangle, const GeometryBatch& batch, std::size_t first) {
    TriangleWork work;
    work.outcome = triangle.outcome;
    work.new_vertices = triangle.new_vertices;
    work.pieces = 0;
    for (std::size_t i = 0; i < triangle.pieces; ++i) {
      const Piece piece = batch.piece(first + i);
      if (culled(piece)) continue;
      ++work.pieces;
      if (piece.setup.covers) rasterize(piece, work);
    }
    if (work.pieces == 0 && triangle.pieces != 0) work.outcome = TriangleOutcome::back_facing;
    if (work.outcome == TriangleOutcome::drawn && work.quad_count == 0)
      work.outcome = TriangleOutcome::no_coverage;
    count(work);
    if (record_) work_.triangles.push_back(work);
  }

  void rasterize(const Piece& piece, TriangleWork& work) {
    work.tile_count += raster::tiles_touched(piece.setup);
    fragments_.begin(piece.setup, piece.corners);
    for (int y = piece.setup.top & ~1; y < piece.setup.bottom; y += raster::kWindow) {
      const raster::BandCounts counts = raster::rasterize_band(piece.setup, depth_, y, windows_);
      counters_.fragments += counts.covered;
      counters_.fragments_passed += counts.passed;
      work.quad_count += counts.quads;
      if (record_ || state_.color_write) pass_quads(std::span(windows_).first(counts.windows));
    }
    fragments_.end();
  }

  // The quads of a band in their order, which is that of rows: through all windows first.
  void pass_quads(std::span<const raster::Window> windows) {
    for (unsigned row = 0; row < raster::kWindow / 2; ++row) {
      for (const raster::Window& window : windows) {
        auto left = static_cast<unsigned>((record_ ? window.covered : window.passed) >> 16 * row & 0xffffu);
        while (left != 0) {
          const unsigned column = static_cast<unsigned>(std::countr_zero(left)) / 4;
          left &= ~(0xfu << 4 * column);
          pass_quad(window, row, column);
        }
      }
    }
  }

  void pass_quad(const raster::Window& window, unsigned row, unsigned column) {
    const unsigned bit = 16 * row + 4 * column;
    const int x = window.x + static_cast<int>(2 * column), y = window.y + static_cast<int>(2 * row);
    const auto passed = static_cast<unsigned>(window.passed >> bit & 0xfu);
    if (record_) {
      work_.quads.push_back({static_cast<std::uint16_t>(x / 2), static_cast<std::uint16_t>(y / 2),
                             static_cast<std::uint8_t>(window.covered >> bit & 0xfu),
                             static_cast<std::uint8_t>(passed), 0});
    }
    if (passed != 0 && state_.color_write) fragments_.push_quad(x, y, passed);
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

  const DrawState& state_;
  bool record_;
  DrawWork& work_;
  RenderCounters& counters_;
  FragmentPipe fragments_;
  raster::DepthTarget depth_;
  std::array<raster::Window, raster::kMaxWindows> windows_;
};

}  // namespace

// Geometry of several batches at once, rasterised one after the other: the same bits from any number of
// threads.
void render_draw(const DrawBindings& bindings, const RenderOptions& options, Frame& frame, DrawWork& work,
                 RenderCounters& counters) {
  Indices indices(bindings, options.vertex_cache_entries);
  RasterStage raster_stage(bindings, options, frame, work, counters);
  const auto make_batch = [&] {
    return std::make_unique<GeometryBatch>(bindings, options, primitive::Viewport{frame.width, frame.height});
  };
  std::array<std::unique_ptr<GeometryBatch>, kBatchesInFlight> batches;
  std::size_t next = 0;
  using tbb::filter_mode;
  tbb::parallel_pipeline(
      kBatchesInFlight,
      tbb::make_filter<void, GeometryBatch*>(filter_mode::serial_in_order,
                                             [&](tbb::flow_control& control) -> GeometryBatch* {
                                               auto& batch = batches[next++ % kBatchesInFlight];
                                               if (!batch) batch = make_batch();
                                               if (indices.fill(*batch)) return batch.get();
                                               control.stop();
                                               return nullptr;
                                             }) &
          tbb::make_filter<GeometryBatch*, GeometryBatch*>(filter_mode::parallel,
                                                           [](GeometryBatch* batch) {
                                                             batch->process();
                                                             return batch;
                                                           }) &
          tbb::make_filter<GeometryBatch*, void>(filter_mode::serial_in_order,
                                                 [&](GeometryBatch* batch) { raster_stage.draw(*batch); }));
  raster_stage.finish();
}

}  // namespace splatscope
