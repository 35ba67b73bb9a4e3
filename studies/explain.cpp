#include "studies/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "model/command/load_program.h"
#include "model/error.h"
#include "model/geometry.h"
#include "model/output/blended.h"
#include "model/render.h"
#include "model/vertex/vertex_fetch.h"
#include "studies/shader_case.h"
#include "studies/shader_debugger.h"

namespace splatscope::studies {
namespace {

// Follows one pixel through a trace: the trace is drawn once more, and each draw in pieces, so that there is
// a look before and after every triangle that covers the pixel.
class PixelHistory {
 public:
  PixelHistory(const Trace& trace, const NumberFormats& formats, std::uint32_t x, std::uint32_t y)
      : trace_(trace),
        pixel_(std::size_t{y} * trace.width + x),
        scratch_(++trace_.surfaces),
        diffuse_program_(add_program("ps_1_1\nmov r0, v0\n")),
        texel_program_(add_program("ps_1_1\ntex t0\nmov r0, t0\n")),
        machine_(trace_, formats),
        wide_(trace_, with_float_frame(formats)),
        inputs_(trace_, without_rounding(formats)),
        held_(std::size_t{1} + trace.surfaces) {}

  void add(PixelStep step, Command command) {
    Held& held = held_[step.target];
    step.before = held.stored;
    step.before_in_double = held.in_double;
    step.after_in_double = held.in_double = in_double(step, command);
    waiting_.push_back(std::move(command));
    catch_up();
    const Frame& frame = machine_.target(step.target);
    step.after = held.stored = frame.color(pixel_);
    step.depth = frame.depth_value(pixel_);
    steps.push_back(step);
  }

  // One triangle of `draw`, and before it those from `from` on, which do not cover the pixel.
  void add_triangle(PixelStep step, const Draw& draw, std::uint32_t from) {
    add_others(draw, from, step.triangle);
    const Draw triangle = part(draw, step.triangle, step.triangle + 1);
    step.target = draw.target;
    step.writes_color = draw.state.color_write;
    if (step.writes_color) {
      catch_up();
      step.source = probe(wide_, triangle, draw.pixel_program);
      step.diffuse = probe(inputs_, triangle, diffuse_program_);
      if (draw.texture) step.texel = probe(inputs_, triangle, texel_program_);
      if (draw.source) step.texel = probe(wide_, triangle, texel_program_);
    }
    add(step, triangle);
  }

  // Triangles [from, to) of `draw`, none of which covers the pixel.
  void add_others(const Draw& draw, std::uint32_t from, std::uint32_t to) {
    if (from < to) waiting_.push_back(part(draw, from, to));
  }

  std::vector<PixelStep> steps;

 private:
  // What the pixel is in the frame or in a surface: 0 before the first command.
  struct Held {
    Vec4 stored{};
    PixelStep::Color in_double{};
  };

  static NumberFormats with_float_frame(NumberFormats formats) {
    formats.frame = FrameFormat::float32;
    return formats;
  }

  static NumberFormats without_rounding(NumberFormats formats) {
    formats.combiner = CombinerFormat::unbounded;
    return with_float_frame(formats);
  }

  std::uint32_t add_program(const char* text) {
    trace_.programs.push_back({"probe.ps", text});
    return static_cast<std::uint32_t>(trace_.programs.size() - 1);
  }

  static Draw part(Draw draw, std::uint32_t from, std::uint32_t to) {
    draw.first_index += 3 * from;
    draw.index_count = 3 * (to - from);
    return draw;
  }

  void catch_up() {
    if (waiting_.empty()) return;
    wide_.run(waiting_);
    machine_.run(std::exchange(waiting_, {}));
  }

  static PixelStep::Color in_double(const PixelStep& step, const Command& command) {
    PixelStep::Color color = step.before_in_double;
    if (const auto* clear = std::get_if<Clear>(&command)) std::ranges::copy(clear->color, color.begin());
    if (const auto* draw = std::get_if<Draw>(&command); draw && step.passed && step.writes_color) {
      PixelStep::Color source;
      std::ranges::copy(step.source, source.begin());
      color = output::blended(source, color, draw->state);
    }
    if (std::holds_alternative<NormalizeOnHost>(command) && color[3] > 0) {
      for (std::size_t c = 0; c < 3; ++c) color[c] /= color[3];
      color[3] = 1;
    }
    return color;
  }

  // What `program` gives for the pixel, whatever is in the frame. Surfaces of binary32 hold what they would
  // in double, nearly.
  Vec4 probe(Replay& replay, Draw triangle, std::optional<std::uint32_t> program) const {
    triangle.pixel_program = program;
    triangle.target = scratch_;
    triangle.state.depth_test = false;
    triangle.state.depth_write = false;
    triangle.state.blend = false;
    replay.run({triangle});
    return replay.target(scratch_).color(pixel_);
  }

  Trace trace_;
  std::size_t pixel_;
  std::uint32_t scratch_;  // a surface that the trace does not know
  std::uint32_t diffuse_program_, texel_program_;
  Replay machine_, wide_;         // in the machine's formats, and with frames of binary32
  Replay inputs_;                 // draws probes of what the pixel unit reads, which it would round
  std::vector<Command> waiting_;  // that neither has drawn yet
  std::vector<Held> held_;        // of the frame and of each surface
};

struct CoveringTriangle {
  std::uint32_t triangle;
  bool passed;  // the depth test
};

// The triangles of the draw that cover the pixel, in order.
std::vector<CoveringTriangle> triangles_at(const DrawWork& work, std::uint32_t x, std::uint32_t y) {
  std::vector<CoveringTriangle> found;
  const unsigned bit = (y & 1) * 2 + (x & 1);
  std::size_t quad = 0;
  for (std::uint32_t triangle = 0; triangle < work.triangles.size(); ++triangle) {
    bool covered = false, passed = false;
    for (const std::size_t end = quad + work.triangles[triangle].quad_count; quad < end; ++quad) {
      const QuadWork& q = work.quads[quad];
      if (q.x != x / 2 || q.y != y / 2 || (q.covered >> bit & 1) == 0) continue;
      covered = true;
      passed = passed || (q.passed >> bit & 1) != 0;
    }
    if (covered) found.push_back({triangle, passed});
  }
  return found;
}

std::string text_of(const Vec4& color) {
  return fmt::format("{:.4f} {:.4f} {:.4f} {:.4f}", color[0], color[1], color[2], color[3]);
}

// What the frame or a surface holds: in 8 bits the numbers themselves, else enough digits to tell any two
// apart.
std::string stored_text(const Vec4& color, FrameFormat format) {
  std::string text;
  for (const float c : color) {
    if (!text.empty()) text += ' ';
    text +=
        format == FrameFormat::unorm8 ? fmt::format("{:>3}", std::lround(255 * c)) : fmt::format("{:.9g}", c);
  }
  return text;
}

// The surfaces that a draw writes and samples.
std::string surfaces_text(const Draw& draw) {
  std::string text;
  if (draw.source) text += fmt::format(", from surface {}", *draw.source);
  if (draw.target != 0) text += fmt::format(", into surface {}", draw.target);
  return text;
}

// A texture has alpha alone.
std::string texel_text(const Draw& draw, const Vec4& texel) {
  if (draw.source) return "  texel " + text_of(texel);
  return draw.texture ? fmt::format("  texel alpha {:.4f}", texel[3]) : "";
}

std::string double_text(const PixelStep::Color& color) {
  return fmt::format("{:.8f} {:.8f} {:.8f} {:.8f}", color[0], color[1], color[2], color[3]);
}

const Draw& draw_of(const Trace& trace, std::uint32_t number) {
  std::uint32_t draws = 0;
  for (const Command& command : trace.commands) {
    if (const auto* draw = std::get_if<Draw>(&command); draw && draws++ == number) return *draw;
  }
  throw UserError("--vertex", 0,
                  fmt::format("draw {} of a trace with {}, expected one from 0", number, draws));
}

}  // namespace

std::vector<PixelStep> explain_pixel(const Trace& trace, const NumberFormats& formats, std::uint32_t x,
                                     std::uint32_t y, const Progress& progress) {
  if (x >= trace.width || y >= trace.height) {
    throw UserError("--pixel", 0,
                    fmt::format("{},{} is outside of the frame, expected X below {} and Y below {}", x, y,
                                trace.width, trace.height));
  }
  RenderOptions options;
  options.formats = formats;
  std::vector<std::vector<CoveringTriangle>> covering;  // by draw
  render(trace, options, part(progress, 0, 0.4), {},
         [&](const DrawWork& work) { covering.push_back(triangles_at(work, x, y)); });
  PixelHistory history(trace, formats, x, y);
  std::uint32_t draws = 0;
  for (std::uint32_t i = 0; i < trace.commands.size(); ++i) {
    tell(part(progress, 0.4, 1), i, trace.commands.size());
    const Command& command = trace.commands[i];
    PixelStep step;
    step.command = i;
    if (const auto* draw = std::get_if<Draw>(&command)) {
      step.draw = draws;
      std::uint32_t next = 0;
      for (const auto& [triangle, passed] : covering[draws++]) {
        step.triangle = triangle;
        step.passed = passed;
        history.add_triangle(step, *draw, std::exchange(next, triangle + 1));
      }
      history.add_others(*draw, next, draw->index_count / 3);
      continue;
    }
    step.kind = std::holds_alternative<Clear>(command)     ? PixelStep::Kind::clear
                : std::holds_alternative<Present>(command) ? PixelStep::Kind::present
                                                           : PixelStep::Kind::normalize;
    history.add(step, command);
  }
  return std::move(history.steps);
}

std::string describe(const Trace& trace, const NumberFormats& formats, const std::vector<PixelStep>& steps) {
  const char* const stored = formats.frame == FrameFormat::unorm8 ? "in 8 bits, of 255" : "as stored";
  std::string out;
  std::uint32_t command = ~std::uint32_t{0};
  for (const PixelStep& step : steps) {
    const auto* draw = std::get_if<Draw>(&trace.commands[step.command]);
    if (draw && step.command != command) {
      out += fmt::format("command {}: draw {}, by {}{}\n", step.command, step.draw,
                         trace.programs[draw->vertex_program].name, surfaces_text(*draw));
    }
    command = step.command;
    if (!draw) {
      constexpr const char* kNames[] = {"clear", "", "normalise on the host", "present"};
      out += fmt::format("command {}: {}\n", step.command, kNames[static_cast<int>(step.kind)]);
    } else {
      const auto [a, b, c] = indices_at(trace.buffers[draw->index_buffer],
                                        std::size_t{draw->first_index} + 3 * std::size_t{step.triangle});
      out += fmt::format("  triangle {} of vertices {} {} {}: depth test {}\n", step.triangle, a, b, c,
                         step.passed ? "passed" : "failed");
      if (!step.passed) continue;
      if (step.writes_color) {
        out += fmt::format("    diffuse {}{}  source {}\n", text_of(step.diffuse),
                           texel_text(*draw, step.texel), text_of(step.source));
      }
    }
    if (!draw || step.writes_color) {
      out += fmt::format("    {}: {} before, {} after\n    in double: {} before, {} after\n", stored,
                         stored_text(step.before, formats.frame), stored_text(step.after, formats.frame),
                         double_text(step.before_in_double), double_text(step.after_in_double));
    }
    if (step.target == 0) out += fmt::format("    depth {:.7f}\n", step.depth);
  }
  if (std::ranges::find(steps, PixelStep::Kind::triangle, &PixelStep::kind) == steps.end())
    out += "no triangle covers the pixel\n";
  return out;
}

std::string explain_vertex(const Trace& trace, const NumberFormats& formats, std::uint32_t number,
                           std::uint32_t index) {
  const Draw& draw = draw_of(trace, number);
  const std::vector<std::byte>& bytes = trace.buffers[draw.vertex_buffer].bytes;
  const std::uint64_t vertex = std::uint64_t{draw.base_vertex} + index;
  const std::uint64_t vertices = draw.vertex_stride == 0 ? 0 : bytes.size() / draw.vertex_stride;
  if (vertices <= draw.base_vertex)
    throw UserError("--vertex", 0, fmt::format("draw {} has no vertices, expected a draw with some", number));
  if (vertex >= vertices) {
    throw UserError("--vertex", 0,
                    fmt::format("vertex {} of draw {}, expected one from 0 to {}", index, number,
                                vertices - 1 - draw.base_vertex));
  }
  vertex::InputBatch inputs;
  vertex::fill_defaults(inputs);
  const auto place = static_cast<std::uint32_t>(vertex);
  vertex::fetch(draw.attributes, bytes, draw.vertex_stride, {&place, 1}, inputs);
  nlohmann::ordered_json registers = {{"constants", nlohmann::ordered_json::object()},
                                      {"inputs", nlohmann::ordered_json::object()}};
  for (std::size_t i = 0; i < draw.constants.size(); ++i)
    registers["constants"][fmt::format("c{}", i)] = hex_of(draw.constants[i]);
  for (const VertexAttribute& attribute : draw.attributes) {
    const auto& v = inputs.v[attribute.input];
    registers["inputs"][fmt::format("v{}", attribute.input)] = hex_of({v[0][0], v[1][0], v[2][0], v[3][0]});
  }
  const ShaderText& shader = trace.programs[draw.vertex_program];
  ShaderDebugger debugger(load_program(shader), ShaderCase::of_object(std::move(registers), "--vertex", 0),
                          formats.vertex_arithmetic, formats.reciprocal_bits);
  std::istringstream commands("continue\nprint\n");
  std::ostringstream out;
  debugger.run(commands, "--vertex", out, false);
  return fmt::format("vertex {} of draw {}, by {}\n", index, number, shader.name) + out.str();
}

}  // namespace splatscope::studies
