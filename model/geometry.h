#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "model/draw.h"
#include "model/raster/interpolate.h"

// From indices to triangles that are set up, a batch at a time. A batch knows nothing of the others: a vertex
// that an earlier batch has too is shaded again, to the same bits. So batches can be worked on at once.
namespace splatscope {

// A triangle on the way: what is known of it before it is rasterised.
struct BatchTriangle {
  std::array<std::uint16_t, 3> vertices{};  // places in the batch
  std::uint8_t new_vertices = 0;            // not found in the post-transform FIFO
  std::uint8_t pieces = 1;                  // after clipping, before culling
  TriangleOutcome outcome = TriangleOutcome::drawn;
};

// What passes from stage to stage; what a stage works in is its thread's (Geometry).
class GeometryBatch {
 public:
  // At most: with fewer vertices threads wait for one another more, with more a batch only takes more memory.
  static constexpr std::size_t kVertices = 640, kTriangles = 1600;

  // From now on it takes triangles of this draw, until it is bound to the next.
  void bind(const DrawBindings& bindings) { bindings_ = &bindings; }

  // ---- filled by Indices
  std::vector<std::uint32_t> vertices;         // vertex numbers, base_vertex added
  std::vector<std::uint32_t> shaded_vertices;  // of these, what the machine shades, in order
  std::vector<BatchTriangle> triangles;
  bool only_quads = true;  // triangles 0 1 2 and 0 2 3 of each four vertices in turn
  void clear();

  // Those from number `first` on that are shaded together.
  vertex::NextVertices next_vertices(std::size_t first) const;

  // ---- filled by Geometry
  // The pieces of all triangles, in order.
  raster::Piece piece(std::size_t i) const {
    const auto [a, b, c] = piece_corners_[i];
    return {&setups_[i], {a, b, c}};
  }
  const raster::VertexAttributes& attributes() const { return attributes_; }
  const raster::TriangleSetup& setup(std::size_t piece) const { return setups_[piece]; }
  // Of the rectangles of all pieces together.
  std::int64_t pixels_at_most() const;

 private:
  friend class Geometry;

  template <typename Function>
  void each_attribute(Function function);
  std::span<raster::TriangleSetup> last_setups(std::size_t count);  // of the last pieces

  const DrawBindings* bindings_ = nullptr;
  raster::VertexAttributes attributes_;  // of the vertices, and behind them of clipped corners
  std::uint32_t clipped_corners_ = 0;
  std::vector<raster::TriangleSetup> setups_;  // of each piece; those behind the last one are left over
  std::vector<std::array<std::uint16_t, 3>> piece_corners_;  // their places in `attributes_`
};

// Vertex unit, primitive assembly and triangle setup, on one batch at a time.
class Geometry {
 public:
  Geometry(const RenderOptions& options, const primitive::Viewport& viewport);

  // From now on it takes batches of this draw, until it is bound to the next. What differs from the draw
  // before is made ready anew.
  void bind(const DrawBindings& bindings);

  // Shades the vertices, assembles and sets up the triangles.
  void process(GeometryBatch& batch);

 private:
  void shade();
  bool are_all_inside(std::size_t first, std::size_t count) const;
  void set_up_quads(std::size_t first, std::size_t count);
  void assemble(BatchTriangle& triangle);
  void assemble_slowly(BatchTriangle& triangle);
  void add_piece(std::uint16_t a, std::uint16_t b, std::uint16_t c);
  void set_up();
  raster::SetupOptions setup_options() const;

  const RenderOptions& options_;
  primitive::Viewport viewport_;
  const DrawBindings* bindings_ = nullptr;
  GeometryBatch* batch_ = nullptr;       // that is worked on
  std::vector<VertexAttribute> inputs_;  // that the program reads
  std::optional<vertex::VertexProgram::Bound> program_;
  std::array<std::array<float, GeometryBatch::kVertices>, 4> positions_;  // x y z w
  primitive::ProjectedVertices projected_;
  std::array<primitive::WindowTriangle, primitive::kMaxPieces> clipped_;
  raster::Corners corners_;  // of the last pieces, which are not set up yet
  std::size_t waiting_ = 0;  // how many these are
};

// Three indices of a buffer, from number `first`: those of a triangle of a list. They lie within it.
std::array<std::uint16_t, 3> indices_at(const Buffer& indices, std::size_t first);

// Walks the indices of a draw with the post-transform FIFO, batch by batch; one draw after the other.
class Indices {
 public:
  explicit Indices(int cache_entries);
  // Begins a draw, with the FIFO empty.
  void begin(const DrawBindings& bindings);
  // True: triangles are left for the next batch.
  bool fill(GeometryBatch& batch);

 private:
  struct Known {                 // of an index
    std::uint32_t inserted = 0;  // into the FIFO: 0 never, else 1 + its place in the order of shading
    std::uint32_t batch = 0;     // the last one it was in, times kVertices, and its place there
  };
  bool is_in_fifo(const Known& known) const {
    return known.inserted != 0 && shaded_ - (known.inserted - 1) <= cache_entries_;
  }
  void fill_triangle(const std::array<std::uint16_t, 3>& index, GeometryBatch& batch);
  std::uint32_t quads_ahead(std::uint32_t first_index, const GeometryBatch& batch) const;
  void fill_quads(std::uint32_t first_index, std::uint32_t quads, GeometryBatch& batch);
  void write_down();

  const DrawBindings* bindings_ = nullptr;
  std::uint32_t cache_entries_;
  // Splats are quads of indices that all follow one another, each a step further in batch and FIFO: of such a
  // draw the first says all. It is written down, an entry each, once something else comes; later runs at
  // once.
  bool is_one_run_ = true;
  std::uint32_t run_first_ = 0, run_end_ = 0;  // indices of the last run
  Known run_start_;                            // of the first one
  std::vector<Known> known_;                   // of all indices, where the draw is more than a run
  std::uint32_t position_ = 0;                 // in the draw
  std::uint32_t batch_ = 0;                    // times kVertices; of all draws, as is
  std::uint32_t shaded_ = 0;
};

}  // namespace splatscope
