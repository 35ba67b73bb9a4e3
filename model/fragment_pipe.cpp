#include <algorithm>

#include "model/draw.h"
#include "model/output/output.h"
#include "model/texture/sample.h"

namespace splatscope {
namespace {

// A colour component as the pixel unit receives it.
float received(float value, ColorFormat format) {
  return format == ColorFormat::unorm8 ? static_cast<float>(output::quantize_unorm8(value)) / 255.0f
                                       : output::saturate(value);
}

}  // namespace

FragmentPipe::FragmentPipe(const DrawBindings& bindings, Frame& frame)
    : bindings_(bindings),
      frame_(frame),
      samples_(bindings.texture != nullptr && bindings.pixel != nullptr &&
               (bindings.pixel->texture_stages() & 1u) != 0),
      batch_{} {}

void FragmentPipe::interpolate(const raster::TriangleSetup& setup, const primitive::WindowTriangle& triangle,
                               float dx, float dy) {
  const float inverse_scale = 1.0f / setup.scale.at(dx, dy);
  const float b1 = setup.weight1.at(dx, dy) * inverse_scale, b2 = setup.weight2.at(dx, dy) * inverse_scale;
  for (const int attribute : bindings_.attributes) {
    const Vec4 &a0 = triangle[0].attributes[attribute], &a1 = triangle[1].attributes[attribute],
               &a2 = triangle[2].attributes[attribute];
    for (int c = 0; c < 4; ++c) {
      // In this form an attribute that is the same at all corners stays exactly that.
      const float value = a0[c] + (b1 * (a1[c] - a0[c]) + b2 * (a2[c] - a0[c]));
      if (attribute == primitive::kDiffuse) {
        batch_.v0[c][count_] = received(value, frame_.formats.color);
      } else if (attribute == primitive::kSpecular) {
        batch_.v1[c][count_] = received(value, frame_.formats.color);
      } else {
        batch_.t[attribute - primitive::kTexcoord0][c][count_] = value;
      }
    }
  }
}

int FragmentPipe::push_quad(const raster::TriangleSetup& setup, const primitive::WindowTriangle& triangle,
                            int x, int y, unsigned passed, std::vector<std::uint32_t>& blocks) {
  const std::size_t first_block = blocks.size();
  if (count_ + 4 > pixel::kBatch) flush();
  for (unsigned bit = 0; bit < 4; ++bit) {
    if ((passed >> bit & 1u) == 0) continue;
    const int px = x + static_cast<int>(bit & 1u), py = y + static_cast<int>(bit >> 1);
    interpolate(setup, triangle, static_cast<float>(px - setup.left), static_cast<float>(py - setup.top));
    if (samples_) {
      const texture::Texel texel =
          texture::sample_nearest(*bindings_.texture, batch_.t[0][0][count_], batch_.t[0][1][count_]);
      for (int c = 0; c < 3; ++c) batch_.t[0][c][count_] = 0;  // D3DFMT_A8 has no colour
      batch_.t[0][3][count_] = texel.alpha;
      const auto begin = blocks.begin() + static_cast<std::ptrdiff_t>(first_block);
      if (std::find(begin, blocks.end(), texel.block) == blocks.end()) blocks.push_back(texel.block);
    }
    pixels_[count_++] = static_cast<std::size_t>(py) * frame_.width + static_cast<std::size_t>(px);
  }
  return static_cast<int>(blocks.size() - first_block);
}

void FragmentPipe::flush() {
  if (count_ == 0) return;
  if (bindings_.pixel != nullptr) bindings_.pixel->run({}, batch_, count_);
  const auto& color = bindings_.pixel != nullptr ? batch_.r0 : batch_.v0;
  for (int i = 0; i < count_; ++i) {
    output::write_color({color[0][i], color[1][i], color[2][i], color[3][i]}, pixels_[i],
                        bindings_.draw.state, frame_);
  }
  count_ = 0;
}

}  // namespace splatscope
