#pragma once

#include <span>
#include <vector>

#include "model/pixel/pixel_program.h"
#include "model/primitive/primitive.h"
#include "model/raster/interpolate.h"
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
  const Frame* source;  // surface that is sampled in place of a texture, or null
  const vertex::VertexProgram& vertex;
  const pixel::PixelProgram* pixel;
  std::span<const primitive::UsedAttribute> attributes;  // that the pixel program reads
};

class Indices;  // geometry.h

// Runs one draw on `frame`, adds what it did to `work` (where wanted) and to `counters`. `indices` serves one
// draw after the other. The same bits from any number of threads.
void render_draw(const DrawBindings& bindings, const RenderOptions& options, Indices& indices, Frame& frame,
                 DrawWork& work, RenderCounters& counters);

}  // namespace splatscope
