#include "model/geometry.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cstring>
#include <iterator>

#include "model/output/output.h"
#include "model/vertex/vertex_fetch.h"

namespace splatscope {
namespace {

constexpr std::uint32_t kCorners = 3;
constexpr std::size_t kIndices = 1 << 16;
constexpr std::uint32_t kManyNumbers = 1u << 31;  // more than that are not given out before a draw

}  // namespace

GeometryBatch::GeometryBatch(const DrawBindings& bindings, const RenderOptions& options,
                             const primitive::Viewport& viewport)
    : bindings_(bindings),
      options_(options),
      viewport_(viewport),
      program_(bindings.vertex, bindings.draw.constants) {
  const unsigned read = bindings.vertex.inputs_read();
  vertex::fill_defaults(program_.input(), read);
  vertex::fill_defaults(program_.grouped_input(), read);
  std::ranges::copy_if(bindings.draw.attributes, std::back_inserter(inputs_),
                       [&](const VertexAttribute& a) { return (read >> a.input & 1u) != 0; });
  for (auto* values : {&projected_.x, &projected_.y, &projected_.z, &projected_.inverse_w})
    values->resize(kVertices);
  projected_.outside.resize(kVertices);
}

void GeometryBatch::clear() {
  vertices.clear();
  shaded_vertices.clear();
  triangles.clear();
  piece_corners_.clear();
  each_attribute([](std::vector<float>& values, std::size_t, std::size_t) { values.resize(kVertices); });
  clipped_corners_ = 0;
  pixels_at_most_ = 0;
}

// function(values of the vertices, attribute, component) for those that the draw reads.
template <typename Function>
void GeometryBatch::each_attribute(Function function) {
  for (const primitive::UsedAttribute& used : bindings_.attributes) {
    const auto attribute = static_cast<std::size_t>(used.attribute);
    for (std::size_t c = 0; c < static_cast<std::size_t>(used.components); ++c)
      function(attributes_[attribute][c], attribute, c);
  }
}

void GeometryBatch::process() {
  shade();
  for (BatchTriangle& triangle : triangles) assemble(triangle);
  set_up();
}

void GeometryBatch::shade() {
  static_assert(kVertices % vertex::kBatch == 0 && vertex::kBatch % primitive::kProjectionLanes == 0);
  const vertex::OutputBatch& out = program_.output();
  const auto& position = out.o[vertex::oPos];
  for (std::size_t first = 0; first < vertices.size(); first += vertex::kBatch) {
    const std::size_t count = std::min<std::size_t>(vertices.size() - first, vertex::kBatch);
    const unsigned grouped = vertex::fetch_grouped(
        inputs_, bindings_.vertices.bytes, bindings_.draw.vertex_stride,
        std::span(vertices).subspan(first, count), program_.input(), program_.grouped_input());
    program_.run(static_cast<int>(count), grouped);
    primitive::project({position[0], position[1], position[2], position[3]}, count, viewport_, projected_,
                       first);
    for (std::size_t c = 0; c < 4; ++c) std::copy_n(position[c], count, positions_[c].data() + first);
    each_attribute([&](std::vector<float>& values, std::size_t attribute, std::size_t c) {
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

void GeometryBatch::assemble(BatchTriangle& triangle) {
  const auto [a, b, c] = triangle.vertices;
  const auto& outside = projected_.outside;
  if (((outside[a] | outside[b] | outside[c]) & primitive::kNotPlain) != 0) return assemble_slowly(triangle);
  if ((outside[a] & outside[b] & outside[c]) != 0) {
    triangle.outcome = TriangleOutcome::outside_frustum;
    return;
  }
  triangle.pieces = 1;
  add_piece(a, b, c);
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    const std::size_t i = triangle.vertices[corner];
    corners_.set(waiting_ - 1, corner, projected_.x[i], projected_.y[i], projected_.z[i],
                 projected_.inverse_w[i]);
  }
}

// With a corner that is not plain: rejected, or clipped.
void GeometryBatch::assemble_slowly(BatchTriangle& triangle) {
  primitive::ClipTriangle corners{};
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    const std::size_t vertex = triangle.vertices[corner];
    for (std::size_t c = 0; c < 4; ++c) corners[corner].position[c] = positions_[c][vertex];
    each_attribute([&](const std::vector<float>& values, std::size_t attribute, std::size_t c) {
      corners[corner].attributes[attribute][c] = values[vertex];
    });
  }
  const primitive::Assembled assembled =
      primitive::assemble(corners, viewport_, bindings_.attributes, clipped_);
  triangle.outcome = assembled.outcome;
  triangle.pieces = static_cast<std::uint8_t>(assembled.pieces);
  for (std::size_t piece = 0; piece < triangle.pieces; ++piece) {
    std::array<std::uint32_t, kCorners> places;
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      places[corner] = static_cast<std::uint32_t>(kVertices) + clipped_corners_++;
      each_attribute([&](std::vector<float>& values, std::size_t attribute, std::size_t c) {
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
void GeometryBatch::add_piece(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (waiting_ == raster::Corners::kCapacity) set_up();
  piece_corners_.push_back({a, b, c});
  ++waiting_;
}

void GeometryBatch::set_up() {
  if (setups_.size() < piece_corners_.size()) setups_.resize(piece_corners_.size());
  const int bits = options_.formats.subpixel_bits;
  const auto out = std::span(setups_).subspan(piece_corners_.size() - waiting_, waiting_);
  raster::set_up(corners_, viewport_, bits, raster::driver_rounding(bits), !bindings_.attributes.empty(),
                 out);
  waiting_ = 0;
  for (const raster::TriangleSetup& setup : out)
    if (setup.covers) pixels_at_most_ += std::int64_t{setup.right - setup.left} * (setup.bottom - setup.top);
}

std::array<std::uint16_t, 3> indices_at(const Buffer& indices, std::size_t first) {
  std::array<std::uint16_t, 3> three;
  std::memcpy(&three, indices.bytes.data() + first * sizeof(std::uint16_t), sizeof three);
  return three;
}

Indices::Indices(int cache_entries)
    : cache_entries_(static_cast<std::uint32_t>(cache_entries)), known_(kIndices) {}

void Indices::begin(const DrawBindings& bindings) {
  bindings_ = &bindings;
  position_ = 0;
  shaded_ += cache_entries_ + 1;  // nothing is left in the FIFO
  if (shaded_ < kManyNumbers && batch_ < kManyNumbers) return;
  std::ranges::fill(known_, Known{});
  batch_ = shaded_ = 0;
}

// Its bytes come from memory while others are filled in.
void Indices::prefetch(std::uint32_t vertex) const {
  hwy::Prefetch(bindings_->vertices.bytes.data() + std::size_t{vertex} * bindings_->draw.vertex_stride);
}

void Indices::fill_triangle(const std::array<std::uint16_t, 3>& index, GeometryBatch& batch) {
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
      prefetch(vertex);
    }
    triangle.vertices[corner] = static_cast<std::uint16_t>(known.batch - batch_);
  }
}

// The same for two triangles at once where they are 0 1 2 and 0 2 3 of four vertices that follow one another,
// as splats are drawn, and all four are new. False: they are not, and nothing has been done.
bool Indices::fill_quad(const std::array<std::uint16_t, 3>& index, GeometryBatch& batch) {
  constexpr std::uint32_t kQuad = 4, kFewestEntries = kCorners;  // of the FIFO, that keep the first vertex
  const Draw& draw = bindings_->draw;
  const auto place = static_cast<std::uint32_t>(batch.vertices.size());
  if (position_ + 2 * kCorners > draw.index_count || place + kQuad > GeometryBatch::kVertices ||
      cache_entries_ < kFewestEntries)
    return false;
  const auto [a, b, c] = index;
  const auto [d, e, f] = indices_at(bindings_->indices, draw.first_index + position_ + kCorners);
  if (b != a + 1 || c != a + 2 || d != a || e != c || f != a + 3) return false;
  const std::span<Known> known(&known_[a], kQuad);
  if (std::ranges::any_of(known, [&](const Known& k) { return k.batch >= batch_ || is_in_fifo(k); }))
    return false;
  const std::uint32_t vertex = draw.base_vertex + a;
  for (std::uint32_t i = 0; i < kQuad; ++i) {
    known[i] = {shaded_ + i + 1, batch_ + place + i};
    prefetch(vertex + i);
  }
  shaded_ += kQuad;
  for (auto* vertices : {&batch.vertices, &batch.shaded_vertices})
    vertices->insert(vertices->end(), {vertex, vertex + 1, vertex + 2, vertex + 3});
  const auto at = [place](std::uint32_t i) { return static_cast<std::uint16_t>(place + i); };
  batch.triangles.push_back({{at(0), at(1), at(2)}, 3});
  batch.triangles.push_back({{at(0), at(2), at(3)}, 1});
  return true;
}

bool Indices::fill(GeometryBatch& batch) {
  batch.clear();
  batch_ += GeometryBatch::kVertices;
  const Draw& draw = bindings_->draw;
  while (position_ + kCorners <= draw.index_count) {
    const auto index = indices_at(bindings_->indices, draw.first_index + position_);
    if (fill_quad(index, batch)) {
      position_ += 2 * kCorners;
      continue;
    }
    std::size_t size = batch.vertices.size();  // with this triangle, at most
    for (const std::uint16_t corner : index) size += known_[corner].batch < batch_;
    // Exactly full, a batch of whole quads ends with one.
    if (size > GeometryBatch::kVertices) break;
    fill_triangle(index, batch);
    position_ += kCorners;
  }
  return !batch.triangles.empty();
}

}  // namespace splatscope
