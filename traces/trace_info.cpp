#include "traces/trace_info.h"

#include <fmt/format.h>

namespace splatscope::traces {
namespace {

constexpr std::string_view name(MemoryPlace place) {
  return place == MemoryPlace::video ? "video" : "AGP";
}

std::string describe(const Trace&, const Clear& c) {
  return fmt::format("clear to r {:g} g {:g} b {:g} a {:g}, depth {:g}", c.color[0], c.color[1], c.color[2],
                     c.color[3], c.depth);
}

std::string describe(const Trace&, const NormalizeOnHost&) {
  return "normalize on the host";
}

std::string describe(const Trace&, const Present&) {
  return "present";
}

std::string describe(const Trace& trace, const Draw& draw) {
  std::string text =
      fmt::format("draw {} triangles, {}", draw.index_count / 3, trace.programs[draw.vertex_program].name);
  if (draw.pixel_program) text += fmt::format(", {}", trace.programs[*draw.pixel_program].name);
  text += fmt::format(", {} bytes a vertex from {} memory", draw.vertex_stride,
                      name(trace.buffers[draw.vertex_buffer].place));
  if (draw.texture) text += fmt::format(", texture {}", *draw.texture);
  if (draw.source) text += fmt::format(", from surface {}", *draw.source);
  if (draw.target != 0) text += fmt::format(", into surface {}", draw.target);
  const DrawState& s = draw.state;
  if (s.depth_test) text += ", depth test";
  if (s.depth_write) text += ", depth write";
  if (s.color_write) text += s.blend ? ", blended" : ", colour write";
  if (s.cull == CullMode::clockwise) text += ", clockwise culled";
  if (s.cull == CullMode::counter_clockwise) text += ", counter-clockwise culled";
  return text;
}

}  // namespace

std::string describe(const Trace& trace) {
  std::string text =
      fmt::format("frame      {} x {}\nframes     {}\n", trace.width, trace.height, frame_ends(trace).size());
  if (trace.surfaces != 0) text += fmt::format("surfaces   {} off-screen\n", trace.surfaces);
  for (std::size_t i = 0; i < trace.buffers.size(); ++i)
    text += fmt::format("buffer     {}: {} bytes in {} memory\n", i, trace.buffers[i].bytes.size(),
                        name(trace.buffers[i].place));
  for (std::size_t i = 0; i < trace.textures.size(); ++i)
    text += fmt::format("texture    {}: {} x {}, 8-bit alpha\n", i, trace.textures[i].width,
                        trace.textures[i].height);
  for (std::size_t i = 0; i < trace.programs.size(); ++i)
    text += fmt::format("program    {}: {}, {} bytes\n", i, trace.programs[i].name,
                        trace.programs[i].text.size());
  for (std::size_t i = 0; i < trace.commands.size(); ++i)
    text += fmt::format("command    {}: {}\n", i,
                        std::visit([&](const auto& c) { return describe(trace, c); }, trace.commands[i]));
  return text;
}

}  // namespace splatscope::traces
