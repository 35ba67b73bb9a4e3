#include "model/fragment_pipe.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "model/output/output.h"
#include "model/texture/sample.h"

namespace splatscope {
namespace {

static_assert(FragmentPipe::kCapacity == pixel::kBatch);
static_assert(raster::kFragmentStride == pixel::kLaneStride);

// Pixels of a quad by its mask: std::popcount is a call where no processor's instruction may be assumed.
constexpr std::array<std::uint8_t, 16> kBitsSet = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

}  // namespace

FragmentPipe::FragmentPipe(std::uint32_t width, const NumberFormats& formats)
    : width_(width), formats_(formats) {
  attributes_[primitive::kDiffuse] = &batch_.v0;
  attributes_[primitive::kSpecular] = &batch_.v1;
}

void FragmentPipe::bind(const DrawBindings& bindings) {
  const DrawBindings* const before = std::exchange(bindings_, &bindings);
  if (before != nullptr && before->pixel == bindings.pixel && before->texture == bindings.texture &&
      before->source == bindings.source)
    return;
  samples_ = (bindings.texture != nullptr || bindings.source != nullptr) && bindings.pixel != nullptr &&
             (bindings.pixel->texture_stages() & 1u) != 0;
  for (std::size_t stage = 0; primitive::kTexcoord0 + stage < primitive::kAttributes; ++stage)
    attributes_[primitive::kTexcoord0 + stage] = &batch_.t[stage];
  if (samples_) attributes_[primitive::kTexcoord0] = &coordinates_;
  batch_ = {};  // what no attribute and no texture gives is 0
}

void FragmentPipe::begin(const raster::VertexAttributes& vertices, Write write) {
  vertices_ = &vertices;
  write_ = std::move(write);
}

// Window by window, as a rasteriser that visits tiles sends their quads.
void FragmentPipe::push_band(const raster::Piece& piece, std::span<const raster::Window> windows,
                             DrawWork* work) {
  if (work != work_) flush();  // fragments of one batch are all noted, or none
  work_ = work;
  for (const raster::Window& window : windows) {
    if (count_ + static_cast<std::size_t>(std::popcount(window.passed)) > kCapacity) flush();
    if (work_ != nullptr) note_quads(window);
    if (bindings_->draw.state.color_write) push_window(piece, window);
  }
}

void FragmentPipe::push_window(const raster::Piece& piece, const raster::Window& window) {
  const std::size_t first = count_;
  count_ = raster::append_places(window, count_, places_);
  if (count_ == first) return;
  if (piece_count_ == 0 || pieces_[piece_count_ - 1].piece.setup != piece.setup)
    pieces_[piece_count_++] = {piece, first, count_};
  pieces_[piece_count_ - 1].end = count_;
}

// The quads, and which of them each fragment that comes next is of.
void FragmentPipe::note_quads(const raster::Window& window) {
  std::vector<QuadWork>& all = work_->quads;
  std::size_t fragment = count_, noted = all.size();
  all.resize(noted + raster::kWindow * raster::kWindow / 4);  // as many as it can be
  for (std::uint64_t covered = window.covered; covered != 0;) {
    const auto quad = static_cast<unsigned>(std::countr_zero(covered)) / 4;
    const auto covered_here = static_cast<std::uint8_t>(covered >> 4 * quad & 0xfu);
    const auto passed_here = static_cast<std::uint8_t>(window.passed >> 4 * quad & 0xfu);
    covered &= ~(std::uint64_t{0xf} << 4 * quad);
    // Of all four; those that did not pass are overwritten.
    std::fill_n(quads_.begin() + static_cast<std::ptrdiff_t>(fragment), 4, static_cast<std::uint32_t>(noted));
    fragment += kBitsSet[passed_here];
    all[noted++] = {static_cast<std::uint16_t>(window.x / 2 + raster::Window::x_of(4 * quad) / 2),
                    static_cast<std::uint16_t>(window.y / 2 + raster::Window::y_of(4 * quad) / 2),
                    covered_here, passed_here, 0};
  }
  all.resize(noted);
}

void FragmentPipe::note_blocks(std::span<const std::uint32_t> blocks) {
  std::vector<std::uint32_t>& all = work_->texel_blocks;
  std::size_t noted = all.size();
  all.resize(noted + blocks.size());  // as many as it can be
  for (std::size_t i = 0; i < blocks.size();) {
    const std::uint32_t quad = quads_[i];
    const std::size_t first = noted;
    for (; i < blocks.size() && quads_[i] == quad; ++i) {
      bool is_known = false;
      for (std::size_t known = first; known < noted; ++known) is_known |= all[known] == blocks[i];
      all[noted] = blocks[i];
      noted += !is_known;
    }
    work_->quads[quad].texel_block_count = static_cast<std::uint8_t>(noted - first);
  }
  all.resize(noted);
}

// D3DFMT_A8 has no colour: the other components of t0 stay 0.
void FragmentPipe::sample(std::size_t count) {
  std::array<std::uint32_t, kCapacity> blocks;
  if (bindings_->source != nullptr) {
    auto& t0 = batch_.t[0];
    texture::sample_surface(*bindings_->source, coordinates_[0], coordinates_[1],
                            {t0[0], t0[1], t0[2], t0[3]}, std::span(blocks).first(count));
    if (work_ != nullptr) note_blocks(std::span(blocks).first(count));
    return;
  }
  const auto noted = std::span(blocks).first(work_ != nullptr ? count : 0);
  const std::span<float> alpha(batch_.t[0][3], count);
  texture::sample_nearest(*bindings_->texture, coordinates_[0], coordinates_[1], alpha, noted);
  if (formats_.filter_bits > 0)
    texture::sample_bilinear(*bindings_->texture, formats_.filter_bits, coordinates_[0], coordinates_[1],
                             alpha);
  if (work_ != nullptr) note_blocks(noted);
}

void FragmentPipe::flush() {
  if (count_ == 0) return;
  raster::interpolate(std::span(pieces_).first(piece_count_), bindings_->attributes, *vertices_, places_,
                      count_, width_, pixels_, attributes_);
  for (const primitive::UsedAttribute& used : bindings_->attributes)
    if (used.attribute <= primitive::kSpecular)
      for (float* values : *attributes_[static_cast<std::size_t>(used.attribute)])
        output::receive_colors(values, count_, formats_.color);
  if (samples_) sample(count_);
  if (bindings_->pixel != nullptr) bindings_->pixel->run({}, batch_, static_cast<int>(count_));
  const auto& color = bindings_->pixel != nullptr ? batch_.r0 : batch_.v0;
  write_({color[0], color[1], color[2], color[3]}, {pixels_.data(), count_});
  count_ = piece_count_ = 0;
}

}  // namespace splatscope
