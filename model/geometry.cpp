#include "model/geometry.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "model/output/output.h"
#include "model/vertex/vertex_fetch.h"

namespace splatscope {
namespace {

constexpr std::uint32_t kCorners = 3, kQuad = 4, kQuadIndices = 6;
constexpr std::size_t kIndices = 1 << 16;
constexpr std::uint32_t kManyNumbers = 1u << 31;  // more than that are not given out before a draw

// Bit by bit: of -0 and +0 the reciprocals differ.
bool are_same(std::span<const Vec4> a, std::span<const Vec4> b) {
  return std::ranges::equal(std::as_bytes(a), std::as_bytes(b));
}

}  // namespace

void GeometryBatch::clear() {
  vertices.clear();
  shaded_vertices.clear();
  triangles.clear();
  piece_corners_.clear();
  each_attribute([](std::vector<float>& values, std::size_t, std::size_t) { values.resize(kVertices); });
  only_quads = true;
  clipped_corners_ = 0;
}

// function(values of the vertices, attribute, component) for those that the draw reads.
template <typename Function>
void GeometryBatch::each_attribute(Function function) {
  for (const primitive::UsedAttribute& used : bindings_->attributes) {
    const auto attribute = static_cast<std::size_t>(used.attribute);
    for (std::size_t c = 0; c < static_cast<std::size_t>(used.components); ++c)
      function(attributes_[attribute][c], attribute, c);
  }
}

vertex::NextVertices GeometryBatch::next_vertices(std::size_t first) const {
  const std::size_t count = std::min<std::size_t>(vertices.size() - first, vertex::kBatch);
  return {bindings_->vertices.bytes, bindings_->draw.vertex_stride,
          std::span(vertices).subspan(first, count)};
}

std::span<raster::TriangleSetup> GeometryBatch::last_setups(std::size_t count) {
  if (setups_.size() < piece_corners_.size()) setups_.resize(piece_corners_.size());
  return std::span(setups_).first(piece_corners_.size()).last(count);
}

std::int64_t GeometryBatch::pixels_at_most() const {
  std::int64_t pixels = 0;
  for (const raster::TriangleSetup& setup : std::span(setups_).first(piece_corners_.size()))
    if (setup.covers) pixels += std::int64_t{setup.right - setup.left} * (setup.bottom - setup.top);
  return pixels;
}

Geometry::Geometry(const RenderOptions& options, const primitive::Viewport& viewport)
    : options_(options), viewport_(viewport) {
  for (auto* values : {&projected_.x, &projected_.y, &projected_.z, &projected_.inverse_w})
    values->resize(GeometryBatch::kVertices);
  projected_.outside.resize(GeometryBatch::kVertices);
}

void Geometry::bind(const DrawBindings& bindings) {
  const DrawBindings* const before = std::exchange(bindings_, &bindings);
  if (before != nullptr && &before->vertex == &bindings.vertex &&
      before->draw.attributes == bindings.draw.attributes &&
      are_same(before->draw.constants, bindings.draw.constants))
    return;
  program_.emplace(bindings.vertex, bindings.draw.constants);
  const unsigned read = bindings.vertex.inputs_read();
  vertex::fill_defaults(program_->input(), read);
  vertex::fill_defaults(program_->grouped_input(), read);
  inputs_.clear();
  std::ranges::copy_if(bindings.draw.attributes, std::back_inserter(inputs_),
                       [&](const VertexAttribute& a) { return (read >> a.input & 1u) != 0; });
}

void Geometry::process(GeometryBatch& batch) {
  batch_ = &batch;
  batch.setups_.reserve(batch.triangles.size());
  batch.piece_corners_.reserve(batch.triangles.size());
  shade();
  for (std::size_t first = 0; first < batch.triangles.size(); first += raster::Corners::kCapacity) {
    const std::size_t count = std::min(batch.triangles.size() - first, raster::Corners::kCapacity);
    if (batch.only_quads && are_all_inside(first, count)) {
      set_up_quads(first, count);
    } else {
      for (BatchTriangle& triangle : std::span(batch.triangles).subspan(first, count)) assemble(triangle);
      set_up();
    }
  }
}

// The vertices of some triangles of quads, of which 2n and 2n + 1 are of vertices 4n to 4n + 3.
bool Geometry::are_all_inside(std::size_t first, std::size_t count) const {
  const auto outside = std::span(projected_.outside).subspan(2 * first, 2 * count);
  return std::reduce(outside.begin(), outside.end(), 0, std::bit_or{}) == 0;
}

void Geometry::shade() {
  static_assert(GeometryBatch::kVertices % vertex::kBatch == 0 &&
                vertex::kBatch % primitive::kProjectionLanes == 0);
  const std::span<const std::uint32_t> vertices = batch_->vertices;
  const vertex::OutputBatch& out = program_->output();
  const auto& position = out.o[vertex::oPos];
  for (std::size_t first = 0; first < vertices.size(); first += vertex::kBatch) {
    const std::size_t count = std::min<std::size_t>(vertices.size() - first, vertex::kBatch);
    const unsigned grouped =
        vertex::fetch_grouped(inputs_, bindings_->vertices.bytes, bindings_->draw.vertex_stride,
                              vertices.subspan(first, count), program_->input(), program_->grouped_input());
    program_->run(static_cast<int>(count), grouped, batch_->next_vertices(first + count));
    primitive::project({position[0], position[1], position[2], position[3]}, count, viewport_, projected_,
                       first);
    for (std::size_t c = 0; c < 4; ++c) std::copy_n(position[c], count, positions_[c].data() + first);
    batch_->each_attribute([&](std::vector<float>& values, std::size_t attribute, std::size_t c) {
      const std::span from(out.o[vertex::oD0 + attribute][c], count);  // both orders are D0, D1, T0, T1, ...
      const auto to = values.begin() + static_cast<std::ptrdiff_t>(first);
      if (attribute <= primitive::kSpecular) {
        std::ranges::transform(from, to, output::saturate);  // on the way out of the unit
      } else {
        std::ranges::copy(from, to);
      }
    });
  }
}

// assemble() and set_up() of triangles of which nothing is outside.
void Geometry::set_up_quads(std::size_t first, std::size_t count) {
  static_assert(2 * raster::Corners::kCapacity % raster::kQuadVertices == 0 &&
                GeometryBatch::kVertices % raster::kQuadVertices == 0);
  std::ranges::transform(std::span(batch_->triangles).subspan(first, count),
                         std::back_inserter(batch_->piece_corners_), &BatchTriangle::vertices);
  raster::set_up_quads(projected_, 2 * first, setup_options(), batch_->last_setups(count));
}

void Geometry::assemble(BatchTriangle& triangle) {
  const auto [a, b, c] = triangle.vertices;
  const auto& outside = projected_.outside;
  if (((outside[a] | outside[b] | outside[c]) & primitive::kNotPlain) != 0) return assemble_slowly(triangle);
  if ((outside[a] & outside[b] & outside[c]) != 0) {
    triangle.outcome = TriangleOutcome::outside_frustum;
    triangle.pieces = 0;
    return;
  }
  add_piece(a, b, c);
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    const std::size_t i = triangle.vertices[corner];
    corners_.set(waiting_ - 1, corner, projected_.x[i], projected_.y[i], projected_.z[i],
                 projected_.inverse_w[i]);
  }
}

// With a corner that is not plain: rejected, or clipped.
void Geometry::assemble_slowly(BatchTriangle& triangle) {
  primitive::ClipTriangle corners{};
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    const std::size_t vertex = triangle.vertices[corner];
    for (std::size_t c = 0; c < 4; ++c) corners[corner].position[c] = positions_[c][vertex];
    batch_->each_attribute([&](const std::vector<float>& values, std::size_t attribute, std::size_t c) {
      corners[corner].attributes[attribute][c] = values[vertex];
    });
  }
  const primitive::Assembled assembled =
      primitive::assemble(corners, viewport_, bindings_->attributes, clipped_);
  triangle.outcome = assembled.outcome;
  triangle.pieces = static_cast<std::uint8_t>(assembled.pieces);
  static_assert(GeometryBatch::kVertices + GeometryBatch::kTriangles * primitive::kMaxPieces * kCorners <
                1u << 16);
  for (std::size_t piece = 0; piece < triangle.pieces; ++piece) {
    std::array<std::uint16_t, kCorners> places;
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      places[corner] = static_cast<std::uint16_t>(GeometryBatch::kVertices + batch_->clipped_corners_++);
      batch_->each_attribute([&](std::vector<float>& values, std::size_t attribute, std::size_t c) {
        values.push_back(clipped_[piece][corner].attributes[attribute][c]);
      });
    }
    add_piece(places[0], places[1], places[2]);
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      const primitive::WindowVertex& vertex = clipped_[piece][corner];
      corners_.set(waiting_ - 1, corner, vertex.x, vertex.y, vertex.z, vertex.inverse_w);
    }
  }
}

// By value: three words written and then read as fewer, larger ones make a processor wait.
void Geometry::add_piece(std::uint16_t a, std::uint16_t b, std::uint16_t c) {
  if (waiting_ == raster::Corners::kCapacity) set_up();
  batch_->piece_corners_.push_back({a, b, c});
  ++waiting_;
}

void Geometry::set_up() {
  raster::set_up(corners_, setup_options(), batch_->last_setups(waiting_));
  waiting_ = 0;
}

raster::SetupOptions Geometry::setup_options() const {
  const int bits = options_.formats.subpixel_bits;
  return {viewport_, bits, raster::driver_rounding(bits), !bindings_->attributes.empty()};
}

std::array<std::uint16_t, 3> indices_at(const Buffer& indices, std::size_t first) {
  std::array<std::uint16_t, 3> three;
  std::memcpy(&three, indices.bytes.data() + first * sizeof(std::uint16_t), sizeof three);
  return three;
}

Indices::Indices(int cache_entries) : cache_entries_(static_cast<std::uint32_t>(cache_entries)) {}

void Indices::begin(const DrawBindings& bindings) {
  bindings_ = &bindings;
  position_ = 0;
  is_one_run_ = true;
  run_first_ = run_end_ = 0;
  shaded_ += cache_entries_ + 1;  // nothing is left in the FIFO
  if (shaded_ < kManyNumbers && batch_ < kManyNumbers) return;
  std::ranges::fill(known_, Known{});
  batch_ = shaded_ = 0;
}

void Indices::write_down() {
  is_one_run_ = false;
  known_.resize(kIndices);
  for (std::uint32_t i = 0; i < run_end_ - run_first_; ++i)
    known_[run_first_ + i] = {run_start_.inserted + i, run_start_.batch + i};
}

void Indices::fill_triangle(const std::array<std::uint16_t, 3>& index, GeometryBatch& batch) {
  batch.only_quads = false;
  BatchTriangle& triangle = batch.triangles.emplace_back();
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    const std::uint32_t vertex = bindings_->draw.base_vertex + index[corner];
    Known& known = known_[index[corner]];
    if (!is_in_fifo(known)) {
      batch.shaded_vertices.push_back(vertex);
      known.inserted = ++shaded_;
      ++triangle.new_vertices;
    }
    if (known.batch < batch_) {
      known.batch = batch_ + static_cast<std::uint32_t>(batch.vertices.size());
      batch.vertices.push_back(vertex);
    }
    triangle.vertices[corner] = static_cast<std::uint16_t>(known.batch - batch_);
  }
}

// How many quads come next as splats are drawn: triangles 0 1 2 and 0 2 3 of four vertices that follow one
// another, and those of the quad before; all of them new, and none more than `batch` takes.
std::uint32_t Indices::quads_ahead(std::uint32_t first_index, const GeometryBatch& batch) const {
  static_assert(std::endian::native == std::endian::little);
  if (cache_entries_ < kCorners)
    return 0;  // a shorter FIFO has lost a quad's first vertex by its second triangle
  const Draw& draw = bindings_->draw;
  const std::byte* at =
      bindings_->indices.bytes.data() + (std::size_t{draw.first_index} + position_) * sizeof(std::uint16_t);
  const std::size_t left = draw.index_count - position_;
  const std::size_t most = std::min(
      {left / kQuadIndices, (GeometryBatch::kTriangles - batch.triangles.size()) / 2,
       (kIndices - first_index) / kQuad, (GeometryBatch::kVertices - batch.vertices.size()) / kQuad});
  const auto is_old = [this](const Known& known) { return known.batch >= batch_ || is_in_fifo(known); };
  for (std::uint32_t quad = 0; quad < most; ++quad, at += kQuadIndices * sizeof(std::uint16_t)) {
    std::uint64_t four;  // indices
    std::uint32_t two;
    std::memcpy(&four, at, sizeof four);
    std::memcpy(&two, at + sizeof four, sizeof two);
    const std::uint32_t first = first_index + quad * kQuad;
    if (four != 0x0000'0002'0001'0000u + first * 0x0001'0001'0001'0001u ||
        two != 0x0003'0002u + first * 0x0001'0001u ||
        (!is_one_run_ && std::ranges::any_of(std::span(&known_[first], kQuad), is_old)))
      return quad;
  }
  return static_cast<std::uint32_t>(most);
}

// fill_triangle() of both triangles of quads_ahead().
void Indices::fill_quads(std::uint32_t first_index, std::uint32_t quads, GeometryBatch& batch) {
  const std::uint32_t count = quads * kQuad, first_vertex = bindings_->draw.base_vertex + first_index;
  const auto place = static_cast<std::uint32_t>(batch.vertices.size());
  const auto append = [](auto& values, std::uint32_t more) {
    values.resize(values.size() + more);
    return std::span(values).last(more);
  };
  const auto vertices = append(batch.vertices, count), shaded = append(batch.shaded_vertices, count);
  std::iota(vertices.begin(), vertices.end(), first_vertex);
  std::iota(shaded.begin(), shaded.end(), first_vertex);
  if (!is_one_run_ || run_end_ == 0) {
    run_first_ = first_index;
    run_start_ = {shaded_ + 1, batch_ + place};
  }
  run_end_ = first_index + count;
  if (!is_one_run_) write_down();
  shaded_ += count;
  for (std::uint32_t quad = 0; quad < quads; ++quad) {
    const auto at = [&](std::uint32_t i) { return static_cast<std::uint16_t>(place + quad * kQuad + i); };
    batch.triangles.push_back({{at(0), at(1), at(2)}, 3});
    batch.triangles.push_back({{at(0), at(2), at(3)}, 1});
  }
}

bool Indices::fill(GeometryBatch& batch) {
  batch.clear();
  batch_ += GeometryBatch::kVertices;
  const Draw& draw = bindings_->draw;
  while (position_ + kCorners <= draw.index_count) {
    const auto index = indices_at(bindings_->indices, draw.first_index + position_);
    if (is_one_run_ && run_end_ != 0 && index[0] != run_end_) write_down();
    if (const std::uint32_t quads = quads_ahead(index[0], batch); quads != 0) {
      fill_quads(index[0], quads, batch);
      position_ += quads * kQuadIndices;
      continue;
    }
    if (is_one_run_) {
      if (batch.vertices.size() == GeometryBatch::kVertices) break;
      write_down();
    }
    std::size_t size = batch.vertices.size();  // with this triangle, at most
    for (const std::uint16_t corner : index) size += known_[corner].batch < batch_;
    // Exactly full, a batch of whole quads ends with one.
    if (size > GeometryBatch::kVertices || batch.triangles.size() == GeometryBatch::kTriangles) break;
    fill_triangle(index, batch);
    position_ += kCorners;
  }
  batch.next_vertices(0).prefetch(0, vertex::kBatch);
  return position_ + kCorners <= draw.index_count;
}

}  // namespace splatscope
