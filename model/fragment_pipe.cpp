#include "model/fragment_pipe.h"

#include <algorithm>

#include "model/output/output.h"
#include "model/texture/sample.h"

namespace splatscope {
namespace {

constexpr std::size_t kCapacity = raster::FragmentPlaces::kCapacity;
static_assert(kCapacity == pixel::kBatch);

}  // namespace

FragmentPipe::FragmentPipe(const DrawBindings& bindings, Frame& frame, DrawWork* work)
    : bindings_(bindings),
      frame_(frame),
      work_(work),
      samples_(bindings.texture != nullptr && bindings.pixel != nullptr &&
               (bindings.pixel->texture_stages() & 1u) != 0) {}

void FragmentPipe::begin(const raster::TriangleSetup& setup,
                         const std::array<const raster::Attributes*, 3>& corners) {
  setup_ = &setup;
  corners_ = corners;
}

void FragmentPipe::push_quad(int x, int y, unsigned passed) {
  if (count_ + 4 > kCapacity) flush();
  const auto left = static_cast<float>(x - setup_->left), top = static_cast<float>(y - setup_->top);
  const std::uint32_t first = static_cast<std::uint32_t>(y) * frame_.width + static_cast<std::uint32_t>(x);
  for (unsigned bit = 0; bit < 4; ++bit) {  // all are stored, and stay where they passed
    places_.x[count_] = left + static_cast<float>(bit & 1u);
    places_.y[count_] = top + static_cast<float>(bit >> 1);
    pixels_[count_] = first + (bit & 1u) + (bit >> 1) * frame_.width;
    if (work_ != nullptr) quads_[count_] = static_cast<std::uint32_t>(work_->quads.size()) - 1;
    count_ += passed >> bit & 1u;
  }
}

void FragmentPipe::end() {
  if (interpolated_ == count_) return;
  raster::interpolate(*setup_, corners_, bindings_.attributes, places_, interpolated_, count_, attributes_);
  interpolated_ = count_;
}

void FragmentPipe::note_blocks(std::span<const std::uint32_t> blocks) {
  std::size_t first = 0;  // of the quad's blocks
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (i == 0 || quads_[i] != quads_[i - 1]) first = work_->texel_blocks.size();
    const auto begin = work_->texel_blocks.begin() + static_cast<std::ptrdiff_t>(first);
    if (std::find(begin, work_->texel_blocks.end(), blocks[i]) != work_->texel_blocks.end()) continue;
    work_->texel_blocks.push_back(blocks[i]);
    ++work_->quads[quads_[i]].texel_block_count;
  }
}

void FragmentPipe::sample(std::size_t count) {
  std::array<std::uint32_t, kCapacity> blocks;
  const auto& coordinates = attributes_.values[primitive::kTexcoord0];
  for (std::size_t c = 0; c < 3; ++c) std::fill_n(batch_.t[0][c], count, 0.0f);  // D3DFMT_A8 has no colour
  const auto noted = std::span(blocks).first(work_ != nullptr ? count : 0);
  texture::sample_nearest(*bindings_.texture, coordinates[0], coordinates[1], {batch_.t[0][3], count}, noted);
  if (const int bits = frame_.formats.filter_bits; bits > 0) {
    texture::sample_bilinear(*bindings_.texture, bits, coordinates[0], coordinates[1],
                             {batch_.t[0][3], count});
  }
  note_blocks(noted);
}

void FragmentPipe::flush() {
  end();
  if (count_ == 0) return;
  for (const primitive::UsedAttribute& used : bindings_.attributes) {
    auto& values = attributes_.values[used.attribute];
    const bool color = used.attribute <= primitive::kSpecular;
    if (used.attribute == primitive::kTexcoord0 && samples_) continue;
    auto& to = used.attribute == primitive::kDiffuse    ? batch_.v0
               : used.attribute == primitive::kSpecular ? batch_.v1
                                                        : batch_.t[used.attribute - primitive::kTexcoord0];
    for (std::size_t c = 0; c < 4; ++c) {
      if (color) output::receive_colors(values[c], count_, frame_.formats.color);
      std::copy_n(values[c], kCapacity, to[c]);
    }
  }
  if (samples_) sample(count_);
  if (bindings_.pixel != nullptr) bindings_.pixel->run({}, batch_, static_cast<int>(count_));
  const auto& color = bindings_.pixel != nullptr ? batch_.r0 : batch_.v0;
  output::write_colors({color[0], color[1], color[2], color[3]}, std::span(pixels_).first(count_),
                       bindings_.draw.state, frame_);
  count_ = interpolated_ = 0;
}

}  // namespace splatscope
