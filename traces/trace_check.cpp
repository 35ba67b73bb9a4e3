#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "model/command/load_program.h"
#include "model/control_characters.h"
#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/program.h"
#include "model/pixel/pixel_program.h"
#include "model/stop.h"
#include "model/vertex/vertex_fetch.h"
#include "traces/trace_file.h"

namespace splatscope::traces {
namespace {

constexpr std::uint32_t kMaxStride = 1024;  // bytes: 16 attributes of 16 bytes, and room
constexpr std::uint32_t kMaxSurfaces = 4;   // off-screen
constexpr std::size_t kMaxFrames = 1000;    // each is a picture of `run`

struct Loaded {
  isa::ShaderKind kind;
  unsigned texture_stages;  // bit n: stage n is sampled
};

// Checks the commands of one trace. `where` names the part that a message is about.
class Checker {
 public:
  Checker(const Trace& trace, std::string_view file) : trace_(trace), file_(file) {}

  void check() {
    where_ = "frame";
    in_range("width", trace_.width, 1, kMostFrameEdge);
    in_range("height", trace_.height, 1, kMostFrameEdge);
    in_range("number of off-screen surfaces", trace_.surfaces, 0, kMaxSurfaces);
    for (std::size_t i = 0; i < trace_.buffers.size(); ++i) {
      where_ = fmt::format("buffer {}", i);
      in_range("memory place", static_cast<unsigned>(trace_.buffers[i].place), 0, 1);
    }
    for (std::size_t i = 0; i < trace_.textures.size(); ++i) {
      where_ = fmt::format("texture {}", i);
      check_texture(trace_.textures[i]);
    }
    for (std::size_t i = 0; i < trace_.programs.size(); ++i) {
      where_ = fmt::format("program {}", i);
      programs_.push_back(check_program(trace_.programs[i]));
    }
    where_ = "frame";
    in_range("number of frames", frame_ends(trace_).size(), 1, kMaxFrames);
    for (std::size_t i = 0; i < trace_.commands.size(); ++i) {
      stop_if_asked();
      where_ = fmt::format("command {}", i);
      std::visit([this](const auto& command) { check_command(command); }, trace_.commands[i]);
    }
  }

 private:
  [[noreturn]] void fail(std::string_view what, std::string_view expected) const {
    throw UserError(file_, 0, fmt::format("{}: {}, expected {}", where_, what, expected));
  }

  void in_range(std::string_view what, std::uint64_t value, std::uint64_t min, std::uint64_t max) const {
    if (value < min || value > max)
      fail(fmt::format("{} is {}", what, value), fmt::format("{} to {}", min, max));
  }

  void in_unit_range(std::string_view what, float value) const {
    if (!(value >= 0 && value <= 1)) fail(fmt::format("{} is {}", what, value), "0 to 1");
  }

  template <class Item>
  const Item& item(std::string_view what, const std::vector<Item>& items, std::uint32_t index) const {
    if (index >= items.size())
      fail(fmt::format("{} {} does not exist", what, index),
           fmt::format("one of the {} in the trace", items.size()));
    return items[index];
  }

  void check_texture(const Texture& texture) const {
    in_range("width", texture.width, 1, kMaxTextureEdge);
    in_range("height", texture.height, 1, kMaxTextureEdge);
    if (texture.bits != 8) fail(fmt::format("texels of {} bits", texture.bits), "8, as a file holds");
    const std::size_t texels = std::size_t{texture.width} * texture.height;
    if (texture.texels.size() != texels)
      fail(fmt::format("{} bytes of texels", texture.texels.size()),
           fmt::format("{} for {} x {}", texels, texture.width, texture.height));
  }

  Loaded check_program(const ShaderText& text) const {
    if (has_control_characters(text.name)) fail("control characters in its name", "a name on one line");
    try {
      const isa::Program program = load_program(text);
      const bool is_pixel = program.version.kind == isa::ShaderKind::pixel;
      if (!is_pixel) return {program.version.kind, 0};
      const pixel::PixelProgram pixel(program);
      if (pixel.samples_ahead()) return {program.version.kind, pixel.texture_stages()};
    } catch (const UserError& error) {
      fail(error.what(), "a program that loads");
    }
    fail(
        "the pixel program samples a stage at other than its own coordinates (in ps_1_4 `texld r1, t1` "
        "samples "
        "stage 1), computes with coordinates, kills fragments or writes depth",
        "one that samples stages at their own coordinates alone");
  }

  const Loaded& program(std::string_view what, std::uint32_t index, isa::ShaderKind kind) const {
    const Loaded& found = item(what, programs_, index);
    if (found.kind != kind)
      fail(fmt::format("program {} is of the other kind", index), fmt::format("a {}", what));
    return found;
  }

  void check_programs(const Draw& draw) const {
    program("vertex program", draw.vertex_program, isa::ShaderKind::vertex);
    if (!draw.pixel_program) return;
    const unsigned stages =
        program("pixel program", *draw.pixel_program, isa::ShaderKind::pixel).texture_stages;
    if (stages & ~1u)
      fail("the pixel program samples a texture stage above 0", "stage 0, the only one of a draw");
    if (stages && !draw.texture && !draw.source)
      fail("the pixel program samples a texture and the draw has none", "one");
  }

  void check_command(const NormalizeOnHost&) const {}
  void check_command(const Present&) const {}

  void check_command(const Clear& clear) const {
    for (float channel : clear.color) in_unit_range("clear color", channel);
    in_unit_range("clear depth", clear.depth);
  }

  void check_command(const Draw& draw) const {
    check_programs(draw);
    if (draw.texture) item("texture", trace_.textures, *draw.texture);
    check_surfaces(draw);
    in_range("number of constants", draw.constants.size(), 0, isa::kVertexConstants);
    const auto last = static_cast<unsigned>(BlendFactor::src_alpha_saturate);
    in_range("source blend factor", static_cast<unsigned>(draw.state.source_factor), 0, last);
    in_range("destination blend factor", static_cast<unsigned>(draw.state.destination_factor), 0, last);
    in_range("cull mode", static_cast<unsigned>(draw.state.cull), 0,
             static_cast<unsigned>(CullMode::counter_clockwise));
    check_attributes(draw);
    check_indices(draw);
  }

  void check_surfaces(const Draw& draw) const {
    in_range("target surface", draw.target, 0, trace_.surfaces);
    if (draw.target != 0 && (draw.state.depth_test || draw.state.depth_write))
      fail("a draw into an off-screen surface tests or writes depth", "neither, as it has none");
    if (!draw.source) return;
    if (trace_.surfaces == 0) fail("a draw samples an off-screen surface", "one in the trace");
    in_range("source surface", *draw.source, 1, trace_.surfaces);
    if (*draw.source == draw.target) fail("a draw samples the surface that it writes", "another one");
    if (draw.texture) fail("a draw samples a texture and a surface", "one of them");
  }

  void check_attributes(const Draw& draw) const {
    in_range("vertex stride", draw.vertex_stride, 1, kMaxStride);
    in_range("number of attributes", draw.attributes.size(), 1, isa::kVertexInputs);
    std::uint32_t seen = 0;
    for (const VertexAttribute& attribute : draw.attributes) {
      in_range("attribute's input register", attribute.input, 0, isa::kVertexInputs - 1);
      if (seen & (1u << attribute.input))
        fail(fmt::format("input register v{} is given twice", attribute.input), "one attribute a register");
      seen |= 1u << attribute.input;
      in_range("attribute's format", static_cast<unsigned>(attribute.format), 0,
               static_cast<unsigned>(VertexFormat::short4));
      if (attribute.offset + vertex::size_of(attribute.format) > draw.vertex_stride)
        fail(fmt::format("attribute of v{} ends at byte {}", attribute.input,
                         attribute.offset + vertex::size_of(attribute.format)),
             fmt::format("an end within the stride of {} bytes", draw.vertex_stride));
    }
  }

  void check_indices(const Draw& draw) const {
    const Buffer& vertices = item("vertex buffer", trace_.buffers, draw.vertex_buffer);
    const Buffer& indices = item("index buffer", trace_.buffers, draw.index_buffer);
    if (draw.index_count % 3 != 0) fail(fmt::format("{} indices", draw.index_count), "a multiple of 3");
    const std::uint64_t stored = indices.bytes.size() / sizeof(std::uint16_t);
    const std::uint64_t end = std::uint64_t{draw.first_index} + draw.index_count;
    if (end > stored)
      fail(fmt::format("indices end at {}", end), fmt::format("an end within the {} of the buffer", stored));
    std::uint16_t largest = 0;
    for (std::uint64_t i = draw.first_index; i < end; ++i) {
      std::uint16_t index = 0;
      std::memcpy(&index, indices.bytes.data() + i * sizeof index, sizeof index);
      largest = std::max(largest, index);
    }
    const std::uint64_t count = vertices.bytes.size() / draw.vertex_stride;
    if (draw.index_count > 0 && std::uint64_t{draw.base_vertex} + largest >= count)
      fail(fmt::format("vertex {} does not exist", std::uint64_t{draw.base_vertex} + largest),
           fmt::format("one of the {} in the buffer", count));
  }

  const Trace& trace_;
  std::string_view file_;
  std::string where_;
  std::vector<Loaded> programs_;  // of the trace
};

}  // namespace

void check_trace(const Trace& trace, std::string_view file) {
  Checker(trace, file).check();
}

}  // namespace splatscope::traces
