#pragma once

#include <vector>

#include "model/pixel/pixel_program.h"
#include "model/primitive/primitive.h"
#include "model/raster/raster.h"
#include "model/render.h"
#include "model/vertex/vertex_program.h"

namespace splatscope {

// What one draw binds, made ready. The programs outlive the draw; `pixel` is null for the plain diffuse
// colour.
struct DrawBindings {
  const Draw& draw;
  const Buffer& vertices;
  const Buffer& indices;
  const Texture* texture;
  const vertex::VertexProgram& vertex;
  const pixel::PixelProgram* pixel;
  std::span<const int> attributes;  // indices into primitive::Attribute that the pixel program reads
};

// Fragments on their way through the pixel unit, in order; full batches are shaded and written.
class FragmentPipe {
 public:
  FragmentPipe(const DrawBindings& bindings, Frame& frame);

  // Shades the pixels of a quad that passed the depth test. Appends the texel blocks they read to `blocks`
  // (each once) and returns how many. (x, y): first pixel of the quad.
  int push_quad(const raster::TriangleSetup& setup, const primitive::WindowTriangle& triangle, int x, int y,
                unsigned passed, std::vector<std::uint32_t>& blocks);
  void flush();

 private:
  void interpolate(const raster::TriangleSetup& setup, const primitive::WindowTriangle& triangle, float dx,
                   float dy);

  const DrawBindings& bindings_;
  Frame& frame_;
  bool samples_ = false;
  pixel::FragmentBatch batch_;
  std::array<std::size_t, pixel::kBatch> pixels_;
  int count_ = 0;
};

// Runs one draw on `frame`, adds what it did to `work` (where wanted) and to `counters`.
void render_draw(const DrawBindings& bindings, const RenderOptions& options, Frame& frame, DrawWork& work,
                 RenderCounters& counters);

}  // namespace splatscope
