#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "model/pixel/pixel_program.h"
#include "model/primitive/primitive.h"
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

// A draw that is to be run, and its record, in which nothing is noted yet.
struct DrawTask {
  DrawBindings bindings;
  DrawWork work;
};

// Runs the draws of a frame, and of the next. The same bits from any number of threads.
class DrawPipeline {
 public:
  DrawPipeline(const RenderOptions& options, std::uint32_t width, std::uint32_t height,
               RenderCounters& counters);
  ~DrawPipeline();

  // Gives the next draw, or none.
  using Next = std::function<std::optional<DrawTask>()>;
  // Takes what some triangles of a draw did, where it is noted, when they are done. It may leave another
  // record in place of the one that it is given, whose memory is then used again.
  using Done = std::function<void(DrawWork& part)>;

  // Draws on `frame`, one draw behind the other. While one is still drawn the next is begun, so none may
  // sample a frame that another one writes. `next` and `done` are each called in the order of the draws, from
  // any thread and beside one another.
  void run(Frame& frame, const Next& next, const Done& done);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace splatscope
