#include "sim/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "model/error.h"
#include "model/number/frame_value.h"
#include "sim/draw_jobs.h"
#include "sim/kernel/systemc_clocks.h"
#include "sim/units/agp/agp_bus.h"
#include "sim/units/blend/blend_unit.h"
#include "sim/units/depth/depth_unit.h"
#include "sim/units/memory/memory_channel.h"
#include "sim/units/pixel/pixel_unit.h"
#include "sim/units/primitive/primitive_assembly.h"
#include "sim/units/raster/rasteriser.h"
#include "sim/units/setup/triangle_setup.h"
#include "sim/units/texture/texture_unit.h"
#include "sim/units/vertex_fetch/vertex_fetch.h"

namespace splatscope::sim {
namespace {

// Creates units and what connects them. Units come before their channels: a channel asks for their clock
// domains.
class Builder {
 public:
  Builder(SimulatedMachine& machine, const Machine& spec) : machine_(machine), spec_(spec) {}

  template <class T, class... Arguments>
  T& unit(ClockDomain& domain, Arguments&&... arguments) {
    auto made = std::make_unique<T>(std::forward<Arguments>(arguments)...);
    T& reference = *made;
    domain.add(reference, static_cast<std::uint32_t>(machine_.units.size()));
    machine_.units.push_back(std::move(made));
    return reference;
  }

  // `what`: tells two between the same units apart.
  template <class T>
  Channel<T>& channel(Unit& from, Unit& to, int capacity, int latency = 1, std::string_view what = "") {
    const std::string sender = what.empty() ? from.name() : fmt::format("{} ({})", from.name(), what);
    auto made = std::make_unique<Channel<T>>(sender + " to " + to.name(), from, to, capacity, latency);
    Channel<T>& reference = *made;
    machine_.channels.push_back(std::move(made));
    return reference;
  }

  // A way of `client` to video memory, with `reads` in flight at most.
  MemoryPort& video_port(Unit& client, const std::vector<MemoryChannel*>& memory, int reads,
                         std::string_view what = "") {
    MemoryPort& port = add_port(client, reads);
    std::vector<Channel<MemoryRequest>*> requests;
    for (MemoryChannel* served_by : memory) {
      requests.push_back(&channel<MemoryRequest>(client, *served_by, spec_.memory.request_queue, 1, what));
      served_by->connect(port, *requests.back());
    }
    port.connect(requests, static_cast<std::uint32_t>(spec_.memory.interleave_bytes));
    return port;
  }

  MemoryPort& agp_port(Unit& client, AgpBus& agp, int reads, std::string_view what) {
    MemoryPort& port = add_port(client, reads);
    auto& requests = channel<MemoryRequest>(client, agp, spec_.agp.queue, 1, what);
    agp.connect(port, requests);
    port.connect({&requests}, static_cast<std::uint32_t>(spec_.memory.interleave_bytes));
    return port;
  }

 private:
  MemoryPort& add_port(Unit& client, int reads) {
    machine_.ports.push_back(std::make_unique<MemoryPort>(client, static_cast<std::uint32_t>(reads)));
    return *machine_.ports.back();
  }

  SimulatedMachine& machine_;
  const Machine& spec_;
};

// Reads in flight of a frame cache: each waiting quad's line and the entering one's, in parts of one memory
// channel.
int frame_reads(const Machine& spec, const FrameLines& lines, int pending) {
  const int parts = static_cast<int>(lines.line_bytes()) / spec.memory.interleave_bytes;
  return (pending + 1) * std::max(parts, 1);
}

// Reads in flight of the vertex cache: the waiting vertices' and the entering one's, each over lines of the
// widest stride.
int vertex_reads(const Trace& trace, const Machine& spec) {
  int widest = 1;
  for (const Command& command : trace.commands) {
    if (const Draw* draw = std::get_if<Draw>(&command))
      widest = std::max(widest, static_cast<int>(draw->vertex_stride));
  }
  const int lines = (widest + spec.fetch.line_bytes - 2) / spec.fetch.line_bytes + 1;
  return (spec.fetch.pending_vertices + 1) * lines;
}

// The units of a machine; null: the trace does not need it.
struct Units {
  VertexFetch* fetch = nullptr;
  std::vector<VertexUnit*> vertex;
  PrimitiveAssembly* assembly = nullptr;
  TriangleSetup* setup = nullptr;
  Rasteriser* raster = nullptr;
  DepthUnit* depth = nullptr;
  TextureUnit* texture = nullptr;
  PixelUnit* pixel = nullptr;
  BlendUnit* blend = nullptr;
  std::vector<MemoryChannel*> memory;
  CommandProcessor* command = nullptr;
  AgpBus* agp = nullptr;
  Host* host = nullptr;
};

// In the order of the pipeline; the command processor is called last in its domain.
Units create_units(Builder& build, SimulatedMachine& machine, const Trace& trace, const Machine& spec,
                   const MemoryLayout& layout, const Needs& needs) {
  Units u;
  ClockDomain& core = machine.core;
  ClockDomain& bus = machine.bus;
  Completion& completion = machine.completion;
  const int width = spec.pixel.quads_per_clock;
  u.fetch = &build.unit<VertexFetch>(core, "vertex_fetch", completion, spec.fetch);
  for (int i = 0; i < spec.vertex.units; ++i) {
    u.vertex.push_back(&build.unit<VertexUnit>(core, "vertex" + std::to_string(i), completion, spec.vertex,
                                               machine.vertex_programs));
  }
  u.assembly = &build.unit<PrimitiveAssembly>(core, "primitive", completion, spec.primitive);
  u.setup = &build.unit<TriangleSetup>(core, "setup", completion, spec.setup);
  u.raster = &build.unit<Rasteriser>(core, "raster", completion, spec.raster, width);
  u.depth = needs.depth ? &build.unit<DepthUnit>(core, "depth", completion, spec.depth, layout.depth, width)
                        : nullptr;
  u.texture =
      needs.texture ? &build.unit<TextureUnit>(core, "texture", completion, spec.texture, width) : nullptr;
  u.pixel = needs.color ? &build.unit<PixelUnit>(core, "pixel", completion, width) : nullptr;
  u.blend = needs.color ? &build.unit<BlendUnit>(core, "blend", completion, spec.blend, layout.color, width)
                        : nullptr;
  for (int i = 0; i < spec.memory.channels; ++i) {
    u.memory.push_back(&build.unit<MemoryChannel>(core, "memory" + std::to_string(i), spec.memory));
  }
  u.command = &build.unit<CommandProcessor>(core, "command", completion);
  const Femtoseconds bus_period = period_of(spec.clock.bus_megahertz);
  u.agp = needs.agp ? &build.unit<AgpBus>(bus, "agp", spec.agp, bus_period) : nullptr;
  const Host::Pixels frame{std::uint64_t{trace.width} * trace.height,
                           static_cast<int>(layout.color.bytes_per_pixel)};
  u.host = &build.unit<Host>(bus, "host", spec.host, bus_period, trace, frame);
  machine.memory.assign(u.memory.begin(), u.memory.end());
  machine.host = u.host;
  machine.assembly = u.assembly;
  machine.command = u.command;
  return u;
}

// Host and command processor, across the boundary of the clocks.
void connect_host(Builder& build, const Units& u) {
  auto& orders = build.channel<Order>(*u.host, *u.command, 1);
  auto& reports = build.channel<std::uint32_t>(*u.command, *u.host, 1);
  u.host->connect(orders, reports);
  u.command->connect(orders, reports, build.video_port(*u.command, u.memory, 1));
}

// From indices to triangles that are set up; returns where these are.
Items& connect_geometry(Builder& build, const Units& u, const Trace& trace, const Machine& spec) {
  VertexFetch::Ports video{&build.video_port(*u.fetch, u.memory, spec.fetch.index_lines, "indices"),
                           &build.video_port(*u.fetch, u.memory, vertex_reads(trace, spec), "vertices")};
  VertexFetch::Ports over_agp;
  if (u.agp) {
    over_agp = {&build.agp_port(*u.fetch, *u.agp, spec.fetch.index_lines, "indices"),
                &build.agp_port(*u.fetch, *u.agp, vertex_reads(trace, spec), "vertices")};
  }
  std::vector<Channel<VertexNumber>*> vertices_in, vertices_out;
  for (VertexUnit* unit : u.vertex) {
    vertices_in.push_back(&build.channel<VertexNumber>(*u.fetch, *unit, VertexUnit::kInputVertices));
    vertices_out.push_back(&build.channel<VertexNumber>(*unit, *u.assembly, spec.vertex.output_vertices));
    unit->connect(*vertices_in.back(), *vertices_out.back());
  }
  const int on_their_way =
      VertexUnit::kInputVertices + VertexUnit::most_vertices(spec.vertex) + spec.vertex.output_vertices;
  auto& order = build.channel<std::uint8_t>(*u.fetch, *u.assembly, spec.vertex.units * on_their_way);
  u.fetch->connect(video, over_agp, vertices_in, order);
  std::vector<MemoryPlace> places;
  for (const Buffer& buffer : trace.buffers) places.push_back(buffer.place);
  u.fetch->set_places(places);
  auto& triangles = build.channel<std::uint32_t>(*u.assembly, *u.setup, spec.primitive.queue);
  auto& set_up = build.channel<std::uint32_t>(*u.setup, *u.raster, spec.setup.queue, spec.setup.latency);
  u.assembly->connect(order, vertices_out, triangles);
  u.setup->connect(triangles, set_up);
  return set_up;
}

// Rasteriser, then what there is of depth test, texture unit, pixel unit and blending, with ways past the
// depth test and the texture unit for draws that do not use them.
void connect_quads(Builder& build, const Units& u, Items& set_up, const Machine& spec,
                   const MemoryLayout& layout) {
  const auto way = [&](Unit* from, Unit* to, int capacity, int latency) {
    return from && to ? &build.channel<std::uint32_t>(*from, *to, capacity, latency) : nullptr;
  };
  const auto from_raster = [&](Unit* to) {
    return way(u.raster, to, spec.raster.queue, spec.raster.latency);
  };
  const auto from_depth = [&](Unit* to) { return way(u.depth, to, spec.depth.queue, spec.depth.latency); };
  const QuadTargets after_raster{from_raster(u.depth), from_raster(u.texture), from_raster(u.pixel)};
  const QuadTargets after_depth{nullptr, from_depth(u.texture), from_depth(u.pixel)};
  u.raster->connect(set_up, after_raster);
  if (u.depth) {
    u.depth->connect(
        *after_raster.depth, after_depth,
        build.video_port(*u.depth, u.memory, frame_reads(spec, layout.depth, spec.depth.pending)),
        layout.depth_address);
  }
  Items* sampled = way(u.texture, u.pixel, spec.texture.queue, spec.texture.latency);
  if (u.texture) {
    u.texture->connect({after_raster.texture, after_depth.texture, nullptr}, *sampled,
                       build.video_port(*u.texture, u.memory, 4 * (spec.texture.pending + 1)));
  }
  if (u.pixel) {
    Items* shaded = way(u.pixel, u.blend, spec.pixel.queue, spec.pixel.latency);
    u.pixel->connect({after_raster.pixel, after_depth.pixel, sampled}, *shaded);
    u.blend->connect(
        *shaded, build.video_port(*u.blend, u.memory, frame_reads(spec, layout.color, spec.blend.pending)),
        layout.color_address);
  }
}

// What a draw begins in, and what a clear writes and a flush writes back: what the draws `use`, whatever else
// is there.
void set_commands(SimulatedMachine& machine, const Units& u, const Machine& spec, const MemoryLayout& layout,
                  const Needs& use) {
  std::vector<DrawUnit*> draw_units{u.fetch, u.assembly, u.setup, u.raster};
  for (DrawUnit* unit : {static_cast<DrawUnit*>(u.depth), static_cast<DrawUnit*>(u.texture),
                         static_cast<DrawUnit*>(u.pixel), static_cast<DrawUnit*>(u.blend)}) {
    if (unit) draw_units.push_back(unit);
  }
  machine.of_draws.assign(draw_units.begin(), draw_units.end());
  draw_units.insert(draw_units.end(), u.vertex.begin(), u.vertex.end());
  u.command->set_draws(machine.jobs, draw_units);
  std::vector<CommandProcessor::Surface> cleared{{layout.color_address, layout.color.bytes()}};
  if (use.depth && !spec.depth.fast_clear) cleared.push_back({layout.depth_address, layout.depth.bytes()});
  u.command->set_frame(use.depth ? u.depth : nullptr, spec.depth.fast_clear, use.color ? u.blend : nullptr,
                       cleared);
}

}  // namespace

void expect_countable_time(const Trace& trace, const Machine& spec) {
  const auto normalizations = std::ranges::count_if(trace.commands, [](const Command& command) {
    return std::holds_alternative<NormalizeOnHost>(command);
  });
  const double pixels = static_cast<double>(normalizations) * trace.width * trace.height;
  const auto commands = static_cast<double>(trace.commands.size());
  const Femtoseconds pixel_time =
      Host::pixel_time(spec.host, period_of(spec.clock.bus_megahertz), bytes_per_pixel(spec.numbers.frame));
  const double time = commands * static_cast<double>(femtoseconds_of(spec.host.command_nanoseconds)) +
                      pixels * static_cast<double>(pixel_time);
  if (time <= static_cast<double>(kMostTime)) return;
  throw UserError("trace", 0,
                  fmt::format("the host alone takes {:.4f} hours of the machine's time, for {:.0f} commands "
                              "(host.command_nanoseconds) and {:.0f} pixels that it normalises "
                              "(host.uncached_read_nanoseconds, host.uncached_read_bytes, "
                              "host.division_nanoseconds), expected at most 5",
                              time / 3.6e18, commands, pixels));
}

SimulatedMachine::SimulatedMachine(const Machine& machine, Scheduler scheduler)
    : core("core", period_of(machine.clock.core_megahertz), period_of(machine.clock.core_megahertz),
           scheduler),
      bus("bus", period_of(machine.clock.bus_megahertz), period_of(machine.clock.core_megahertz), scheduler) {
  core.set_peers({&bus});
  bus.set_peers({&core});
}

Cycle SimulatedMachine::core_cycle(Cycle bus_cycle) const {
  const Femtoseconds time = bus.time(bus_cycle);
  return time == 0 ? 0 : core.first_after(time - 1);
}

void SimulatedMachine::run() {
  const std::array<ClockDomain*, 2> domains{&core, &bus};
  run_on_systemc(domains);
  if (host->is_finished()) return;
  std::string dump;
  for (const auto& unit : units) {
    if (const std::string state = unit->state(); !state.empty()) dump += "\n  " + unit->name() + ": " + state;
  }
  for (const auto& channel : channels) dump += "\n  " + channel->describe();
  throw ModelError("the simulated machine is deadlocked:" + dump);
}

std::unique_ptr<SimulatedMachine> build_machine(const Trace& trace, PreparedDraws draws,
                                                const MemoryLayout& layout, const Machine& spec,
                                                Scheduler scheduler, UnitChoice choice) {
  expect_countable_time(trace, spec);
  auto machine = std::make_unique<SimulatedMachine>(spec, scheduler);
  const Needs used = needs_of(trace, draws.jobs);
  const Needs needs = choice == UnitChoice::all ? Needs{true, true, true, true} : used;
  machine->vertex_programs = std::move(draws.vertex_programs);
  machine->jobs = std::move(draws.jobs);
  machine->built = needs;

  Builder build(*machine, spec);
  const Units units = create_units(build, *machine, trace, spec, layout, needs);
  connect_host(build, units);
  Items& set_up = connect_geometry(build, units, trace, spec);
  connect_quads(build, units, set_up, spec, layout);
  set_commands(*machine, units, spec, layout, used);
  return machine;
}

}  // namespace splatscope::sim
