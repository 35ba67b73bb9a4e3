#include "model/render.h"

#include <map>

#include "model/draw.h"
#include "model/isa/program.h"
#include "model/output/output.h"

namespace splatscope {
namespace {

// The programs of a trace, each assembled when a draw first uses it.
class Programs {
 public:
  Programs(const Trace& trace, Arithmetic arithmetic) : trace_(trace), arithmetic_(arithmetic) {}

  const vertex::VertexProgram& vertex(std::uint32_t index) {
    const auto found = vertex_.find(index);
    if (found != vertex_.end()) return found->second;
    return vertex_.emplace(index, vertex::VertexProgram(load(index), arithmetic_)).first->second;
  }
  const pixel::PixelProgram& pixel(std::uint32_t index) {
    const auto found = pixel_.find(index);
    if (found != pixel_.end()) return found->second;
    return pixel_.emplace(index, pixel::PixelProgram(load(index))).first->second;
  }

 private:
  isa::Program load(std::uint32_t index) const {
    return isa::load(trace_.programs[index].text, trace_.programs[index].name);
  }
  const Trace& trace_;
  Arithmetic arithmetic_;
  std::map<std::uint32_t, vertex::VertexProgram> vertex_;
  std::map<std::uint32_t, pixel::PixelProgram> pixel_;
};

}  // namespace

Rendered render(const Trace& trace, const RenderOptions& options,
                const std::function<void(double)>& progress) {
  Rendered rendered{Frame(trace.width, trace.height, options.formats), {}, {}};
  output::clear(Clear{}, rendered.frame);
  Programs programs(trace, options.formats.vertex_arithmetic);
  for (std::size_t i = 0; i < trace.commands.size(); ++i) {
    if (progress) progress(static_cast<double>(i) / static_cast<double>(trace.commands.size()));
    const Command& command = trace.commands[i];
    if (const auto* clear = std::get_if<Clear>(&command)) {
      output::clear(*clear, rendered.frame);
    } else if (std::holds_alternative<NormalizeOnHost>(command)) {
      output::normalize(rendered.frame);
    } else {
      const Draw& draw = std::get<Draw>(command);
      const DrawBindings bindings{draw,
                                  trace.buffers[draw.vertex_buffer],
                                  trace.buffers[draw.index_buffer],
                                  draw.texture ? &trace.textures[*draw.texture] : nullptr,
                                  programs.vertex(draw.vertex_program),
                                  draw.pixel_program ? &programs.pixel(*draw.pixel_program) : nullptr};
      DrawWork work;
      work.command = static_cast<std::uint32_t>(i);
      render_draw(bindings, options, rendered.frame, work, rendered.counters);
      if (options.record_work) rendered.work.push_back(std::move(work));
    }
  }
  return rendered;
}

}  // namespace splatscope
