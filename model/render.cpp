#include "model/render.h"

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <utility>

#include "model/command/load_program.h"
#include "model/draw.h"
#include "model/error.h"
#include "model/machine/machine.h"
#include "model/output/output.h"
#include "model/stop.h"

namespace splatscope {
namespace {

// What a draw without a pixel program reads.
constexpr primitive::UsedAttribute kDiffuseOnly[] = {{primitive::kDiffuse, 4}};

struct LoadedPixelProgram {
  pixel::PixelProgram program;
  std::vector<primitive::UsedAttribute> attributes;
};

// The interpolated attributes that a pixel program names. What it samples a 2D texture at has two components.
std::vector<primitive::UsedAttribute> attributes_of(const isa::Program& program, unsigned sampled_stages) {
  std::set<int> attributes;
  const auto add = [&](isa::RegisterFile file, int index) {
    if (file == isa::RegisterFile::input) attributes.insert(primitive::kDiffuse + index);
    if (file == isa::RegisterFile::texture && primitive::kTexcoord0 + index < primitive::kAttributes) {
      attributes.insert(primitive::kTexcoord0 + index);
    }
  };
  for (const isa::Instruction& instruction : program.instructions) {
    add(instruction.destination.file, instruction.destination.index);
    for (const isa::Source& source : instruction.used_sources()) add(source.file, source.index);
  }
  std::vector<primitive::UsedAttribute> used;
  for (const int attribute : attributes) {
    const int stage = attribute - primitive::kTexcoord0;
    used.push_back({attribute, stage >= 0 && (sampled_stages >> stage & 1u) != 0 ? 2 : 4});
  }
  return used;
}

// The programs of a trace, each assembled when a draw first uses it.
class Programs {
 public:
  Programs(const Trace& trace, const NumberFormats& formats) : trace_(trace), formats_(formats) {}

  const vertex::VertexProgram& vertex(std::uint32_t index) {
    const auto found = vertex_.find(index);
    if (found != vertex_.end()) return found->second;
    return vertex_
        .emplace(index, vertex::VertexProgram(load_program(trace_.programs[index]),
                                              formats_.vertex_arithmetic, formats_.reciprocal_bits))
        .first->second;
  }

  const LoadedPixelProgram& pixel(std::uint32_t index) {
    const auto found = pixel_.find(index);
    if (found != pixel_.end()) return found->second;
    const isa::Program program = load_program(trace_.programs[index]);
    LoadedPixelProgram loaded{pixel::PixelProgram(program, formats_.combiner), {}};
    loaded.attributes = attributes_of(program, loaded.program.texture_stages());
    if (!loaded.program.samples_ahead()) {
      throw UserError(
          program.name, 0,
          "a draw of a trace cannot kill fragments, write depth or read textures at computed coordinates; "
          "expected a pixel program whose textures are sampled at their own coordinates");
    }
    return pixel_.emplace(index, std::move(loaded)).first->second;
  }

 private:
  const Trace& trace_;
  const NumberFormats& formats_;
  std::map<std::uint32_t, vertex::VertexProgram> vertex_;
  std::map<std::uint32_t, LoadedPixelProgram> pixel_;
};

// Does commands on the resources of a trace, one after the other.
class Renderer {
 public:
  // `on_part` takes the work of the draws; `progress` is told how many commands are begun.
  Renderer(const Trace& trace, const RenderOptions& options, Rendered& rendered, DrawPipeline::Done on_part,
           std::function<void(std::size_t)> progress)
      : trace_(trace),
        rendered_(rendered),
        on_part_(std::move(on_part)),
        progress_(std::move(progress)),
        programs_(trace, options.formats),
        pipeline_(options, trace.width, trace.height, rendered.counters) {
    for (std::uint32_t i = 0; i < trace.surfaces; ++i)
      surfaces_.emplace_back(trace.width, trace.height, options.formats);
    output::clear(Clear{}, rendered.frame);
  }

  // The commands of a frame, of which the first has the given number. They must outlive the renderer: a draw
  // looks at what the one before it has bound.
  void run_frame(std::span<const Command> commands, std::size_t first) {
    std::uint64_t triangles = 0;
    for (const Command& command : commands)
      if (const Draw* draw = std::get_if<Draw>(&command)) triangles += draw->index_count / 3;
    sampled_runs_apart_ = sampled_runs_apart(triangles);
    commands_ = commands;
    first_ = first;
    next_ = 0;
    while (next_ < commands_.size()) std::visit([&](const auto& body) { run(body); }, commands_[next_]);
  }

  // The frame (0) or an off-screen surface.
  Frame& target(std::uint32_t number) { return number == 0 ? rendered_.frame : surfaces_[number - 1]; }

 private:
  // The next command; its number.
  std::size_t begin() {
    stop_if_asked();
    const std::size_t number = first_ + next_++;
    progress_(number);
    return number;
  }
  void run(const Clear& clear) {
    begin();
    output::clear(clear, rendered_.frame);
  }
  void run(const NormalizeOnHost&) {
    begin();
    output::normalize(rendered_.frame);
  }
  void run(const Present&) { begin(); }

  // With the draws that follow it on the same target: what they sample is another surface.
  void run(const Draw& first) {
    const auto next_draw_on_it = [&]() -> std::optional<DrawTask> {
      const Draw* draw = next_ < commands_.size() ? std::get_if<Draw>(&commands_[next_]) : nullptr;
      if (draw == nullptr || draw->target != first.target) return std::nullopt;
      return next_draw(*draw);
    };
    pipeline_.run(target(first.target), next_draw_on_it, on_part_);
  }

  DrawTask next_draw(const Draw& draw) {
    const std::size_t command = begin();
    const LoadedPixelProgram* pixel = draw.pixel_program ? &programs_.pixel(*draw.pixel_program) : nullptr;
    DrawTask task{
        {draw, trace_.buffers[draw.vertex_buffer], trace_.buffers[draw.index_buffer],
         draw.texture ? &trace_.textures[*draw.texture] : nullptr,
         draw.source ? &surfaces_[*draw.source - 1] : nullptr, programs_.vertex(draw.vertex_program),
         pixel ? &pixel->program : nullptr, attributes_read(draw, pixel)},
        {}};
    task.work.command = static_cast<std::uint32_t>(command);
    task.work.sampled_runs_apart = sampled_runs_apart_;
    return task;
  }

  static std::span<const primitive::UsedAttribute> attributes_read(const Draw& draw,
                                                                   const LoadedPixelProgram* pixel) {
    if (!draw.state.color_write) return {};
    return pixel ? std::span<const primitive::UsedAttribute>(pixel->attributes) : kDiffuseOnly;
  }

  const Trace& trace_;
  Rendered& rendered_;
  DrawPipeline::Done on_part_;
  std::function<void(std::size_t)> progress_;
  std::vector<Frame> surfaces_;  // off-screen
  Programs programs_;
  DrawPipeline pipeline_;
  std::span<const Command> commands_;  // of the frame
  std::size_t first_ = 0, next_ = 0;   // the number of the first of them, and the next one's place among them
  std::uint32_t sampled_runs_apart_ = 1;
};

// Puts the parts of each draw's work together.
class WholeDraws {
 public:
  WholeDraws(const Trace& trace, std::function<void(DrawWork)> take)
      : trace_(trace), take_(std::move(take)) {}

  void add(const DrawWork& part) {
    const std::size_t triangles = std::get<Draw>(trace_.commands[part.command]).index_count / 3;
    if (!is_begun_) begin(part, triangles);
    whole_.append(part);
    if (whole_.triangles.size() != triangles) return;
    is_begun_ = false;
    take_(std::move(whole_));
  }

 private:
  // For which a record has room from the start. Most splats cover fewer, and what is not touched takes no
  // memory; records that grow are copied into memory that the system has to clear.
  static constexpr std::size_t kQuadsATriangle = 8, kMostTrianglesAhead = 1 << 16;

  void begin(const DrawWork& part, std::size_t triangles) {
    is_begun_ = true;
    whole_ = {};
    whole_.command = part.command;
    whole_.sampled_runs_apart = part.sampled_runs_apart;
    whole_.samples_only = part.samples_only;
    whole_.triangles.reserve(triangles);
    if (part.samples_only) return;
    whole_.shaded_vertices.reserve(2 * triangles);
    const std::size_t quads = kQuadsATriangle * std::min(triangles, kMostTrianglesAhead);
    whole_.quads.reserve(quads);
    whole_.texel_blocks.reserve(quads);
  }

  const Trace& trace_;
  std::function<void(DrawWork)> take_;
  DrawWork whole_;
  bool is_begun_ = false;
};

// A renderer that records nothing, with what it draws on.
struct Unrecorded {
  Unrecorded(const Trace& trace, const RenderOptions& like)
      : options{.formats = like.formats,
                .vertex_cache_entries = like.vertex_cache_entries,
                .record = Record::nothing},
        rendered{Frame(trace.width, trace.height, options.formats), {}, {}},
        renderer(
            trace, options, rendered, [](DrawWork&) {}, [](std::size_t) {}) {}

  RenderOptions options;
  Rendered rendered;
  Renderer renderer;
};

}  // namespace

RenderOptions render_options(const Machine& machine, Record record) {
  return {.formats = machine.numbers, .vertex_cache_entries = machine.vertex.cache_entries, .record = record};
}

Rendered render(const Trace& trace, const RenderOptions& options, const std::function<void(double)>& progress,
                const std::function<void(const Frame&)>& on_frame,
                const std::function<void(DrawWork)>& on_work) {
  std::vector<DrawWork> kept;
  const auto keep = [&](DrawWork work) { kept.push_back(std::move(work)); };
  WholeDraws draws(trace, on_work ? on_work : keep);
  Rendered rendered =
      render_in_parts(trace, options, progress, on_frame, [&](const DrawWork& part) { draws.add(part); });
  rendered.work = std::move(kept);
  return rendered;
}

Rendered render_in_parts(const Trace& trace, const RenderOptions& options,
                         const std::function<void(double)>& progress,
                         const std::function<void(const Frame&)>& on_frame,
                         const std::function<void(DrawWork&)>& on_part) {
  Rendered rendered{Frame(trace.width, trace.height, options.formats), {}, {}};
  const auto tell = [&](std::size_t command) {
    if (progress) progress(static_cast<double>(command) / static_cast<double>(trace.commands.size()));
  };
  Renderer renderer(trace, options, rendered, on_part, tell);
  const std::span<const Command> commands = trace.commands;
  std::size_t first = 0;
  for (const std::size_t end : frame_ends(trace)) {
    renderer.run_frame(commands.subspan(first, end - first), first);
    first = end;
    if (on_frame) on_frame(rendered.frame);
  }
  return rendered;
}

Frame render_view(const Trace& trace, std::span<const Command> commands, RenderOptions options) {
  Unrecorded drawing(trace, options);
  drawing.renderer.run_frame(commands, 0);
  return std::move(drawing.rendered.frame);
}

class Replay::State {
 public:
  State(const Trace& trace, const NumberFormats& formats) : drawing_(trace, {.formats = formats}) {}

  void run(std::vector<Command> commands) {
    done_.push_back(std::move(commands));
    drawing_.renderer.run_frame(done_.back(), 0);
  }
  const Frame& target(std::uint32_t number) { return drawing_.renderer.target(number); }

 private:
  std::deque<std::vector<Command>> done_;  // where the renderer has seen them
  Unrecorded drawing_;
};

Replay::Replay(const Trace& trace, const NumberFormats& formats)
    : state_(std::make_unique<State>(trace, formats)) {}
Replay::~Replay() = default;

void Replay::run(std::vector<Command> commands) {
  state_->run(std::move(commands));
}

const Frame& Replay::target(std::uint32_t number) const {
  return state_->target(number);
}

}  // namespace splatscope
