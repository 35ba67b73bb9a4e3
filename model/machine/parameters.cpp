#include "model/machine/parameters.h"

#include <array>

namespace splatscope::machine {
namespace {

template <typename Value, auto Group, auto Member>
Value get(const Machine& machine) {
  return (machine.*Group).*Member;
}
template <typename Value, auto Group, auto Member>
void set(Machine& machine, Value value) {
  (machine.*Group).*Member = value;
}

template <auto Group, auto Member>
IntegerField integer(int least, int most) {
  return {&get<int, Group, Member>, &set<int, Group, Member>, least, most};
}

template <auto Group, auto Member>
IntegerField power_of_two(int least, int most) {
  return {&get<int, Group, Member>, &set<int, Group, Member>, least, most, true};
}

template <auto Group, auto Member>
RealField real(double least, double most) {
  return {&get<double, Group, Member>, &set<double, Group, Member>, least, most};
}

template <auto Group, auto Member>
SwitchField on_off() {
  return {&get<bool, Group, Member>, &set<bool, Group, Member>};
}

template <auto Member>
ChoiceField choice(std::span<const std::string_view> names) {
  using Value = std::remove_reference_t<decltype(std::declval<NumberFormats&>().*Member)>;
  return {names, [](const Machine& machine) { return static_cast<int>(machine.numbers.*Member); },
          [](Machine& machine, int value) { machine.numbers.*Member = static_cast<Value>(value); }};
}

constexpr std::array<std::string_view, 2> kArithmetics{"ieee", "nv20"};
constexpr std::array<std::string_view, 3> kColorFormats{"unorm8", "float32", "unorm12"};
constexpr std::array<std::string_view, 5> kFrameFormats{"unorm8", "float32", "unorm10", "unorm16", "half"};
constexpr std::array<std::string_view, 3> kFrameRoundings{"nearest", "truncate", "dither"};
constexpr std::array<std::string_view, 2> kCombinerFormats{"float32", "signed9"};
constexpr std::array<std::string_view, 3> kDepthFormats{"z16", "z24", "float32"};

using M = Machine;

std::vector<Parameter> number_parameters() {
  return {
      {"numbers.vertex_arithmetic", "", choice<&NumberFormats::vertex_arithmetic>(kArithmetics),
       "arithmetic of the vertex units"},
      {"numbers.color", "", choice<&NumberFormats::color>(kColorFormats),
       "interpolated colours as the pixel unit sees them"},
      {"numbers.combiner", "", choice<&NumberFormats::combiner>(kCombinerFormats),
       "results in the pixel unit: binary32, or the 9-bit signed steps of register combiners"},
      {"numbers.frame", "", choice<&NumberFormats::frame>(kFrameFormats), "frame buffer, a channel"},
      {"numbers.frame_rounding", "", choice<&NumberFormats::frame_rounding>(kFrameRoundings),
       "of blended colours in a unorm frame buffer"},
      {"numbers.depth", "", choice<&NumberFormats::depth>(kDepthFormats), "depth buffer"},
      {"numbers.subpixel_bits", "bits", integer<&M::numbers, &NumberFormats::subpixel_bits>(0, 8),
       "fraction of window x and y on which coverage is decided"},
      {"numbers.filter_bits", "bits", integer<&M::numbers, &NumberFormats::filter_bits>(0, 8),
       "weights of bilinear texture filtering, 0: the nearest texel; in the picture alone: timing counts "
       "that texel's block"},
      {"numbers.reciprocal_bits", "bits", integer<&M::numbers, &NumberFormats::reciprocal_bits>(8, 24),
       "significant bits that the results of RCP and RSQ are rounded to; 24: all"},
      {"clock.core_megahertz", "MHz", real<&M::clock, &M::Clock::core_megahertz>(1, 10000),
       "clock of the graphics core and of the memory (equal on these machines: one domain)"},
      {"clock.bus_megahertz", "MHz", real<&M::clock, &M::Clock::bus_megahertz>(1, 10000),
       "clock of the AGP bus"},
  };
}

std::vector<Parameter> geometry_parameters() {
  return {
      {"vertex.units", "", integer<&M::vertex, &M::Vertex::units>(1, 16), "vertex units"},
      {"vertex.threads", "vertices", integer<&M::vertex, &M::Vertex::threads>(1, 16),
       "of a unit; each holds a vertex, and they take turns to issue"},
      {"vertex.vector_latency", "clocks", integer<&M::vertex, &M::Vertex::vector_latency>(1, 64),
       "from the issue of a vector instruction to that of one that reads its result"},
      {"vertex.scalar_latency", "clocks", integer<&M::vertex, &M::Vertex::scalar_latency>(1, 64),
       "the same for RCP, RSQ, EXPP, LOGP, LIT"},
      {"vertex.scalar_interval", "clocks", integer<&M::vertex, &M::Vertex::scalar_interval>(1, 64),
       "between two issues of the scalar unit"},
      {"vertex.pairing", "", on_off<&M::vertex, &M::Vertex::pairing>(),
       "a vector and a scalar instruction that stand side by side may share an issue slot"},
      {"vertex.driver_reorders", "", on_off<&M::vertex, &M::Vertex::driver_reorders>(),
       "the driver orders independent instructions for the unit"},
      {"vertex.reload_cycles", "clocks", integer<&M::vertex, &M::Vertex::reload_cycles>(0, 64),
       "in which a thread issues nothing, after the last slot of a vertex and before the next vertex"},
      {"vertex.cache_entries", "vertices", integer<&M::vertex, &M::Vertex::cache_entries>(1, 1024),
       "entries of the post-transform FIFO that an index can hit"},
      {"vertex.output_vertices", "vertices", integer<&M::vertex, &M::Vertex::output_vertices>(1, 64),
       "finished vertices of a unit that can wait for primitive assembly"},
      {"fetch.line_bytes", "bytes", power_of_two<&M::fetch, &M::Fetch::line_bytes>(16, 256),
       "one read of indices or vertices"},
      {"fetch.cache_lines", "lines", power_of_two<&M::fetch, &M::Fetch::cache_lines>(4, 1024),
       "lines of vertices kept"},
      {"fetch.cache_ways", "ways", power_of_two<&M::fetch, &M::Fetch::cache_ways>(1, 16), "its ways"},
      {"fetch.pending_vertices", "vertices", integer<&M::fetch, &M::Fetch::pending_vertices>(1, 1024),
       "read ahead, waiting for their lines"},
      {"fetch.index_lines", "lines", integer<&M::fetch, &M::Fetch::index_lines>(1, 64),
       "lines of indices read ahead"},
      {"fetch.indices_per_clock", "", integer<&M::fetch, &M::Fetch::indices_per_clock>(1, 3),
       "indices taken a clock, those of a triangle from a clock of its own on"},
      {"primitive.clocks_per_triangle", "clocks",
       integer<&M::primitive, &M::Primitive::clocks_per_triangle>(1, 64),
       "to assemble, clip-test and cull a triangle, until the next"},
      {"primitive.clip_clocks", "clocks", integer<&M::primitive, &M::Primitive::clip_clocks>(0, 1024),
       "more for each further triangle that clipping makes"},
      {"primitive.queue", "triangles", integer<&M::primitive, &M::Primitive::queue>(1, 1024),
       "triangles waiting for setup"},
      {"setup.clocks_per_triangle", "clocks", integer<&M::setup, &M::Setup::clocks_per_triangle>(1, 64),
       "to set up a triangle, until the next"},
      {"setup.latency", "clocks", integer<&M::setup, &M::Setup::latency>(1, 256),
       "through the setup pipeline"},
      {"setup.queue", "triangles", integer<&M::setup, &M::Setup::queue>(1, 1024),
       "triangles in and behind the setup pipeline"},
  };
}

std::vector<Parameter> pixel_parameters() {
  return {
      {"raster.tiles_per_clock", "tiles", integer<&M::raster, &M::Raster::tiles_per_clock>(1, 16),
       "8x8-pixel tiles visited a clock, beside the quads of earlier ones"},
      {"raster.latency", "clocks", integer<&M::raster, &M::Raster::latency>(1, 256),
       "through the rasteriser"},
      {"raster.queue", "quads", integer<&M::raster, &M::Raster::queue>(1, 1024),
       "quads in and behind the rasteriser"},
      {"depth.cache_lines", "lines", power_of_two<&M::depth, &M::Depth::cache_lines>(4, 65536),
       "depth cache, lines of 4x4 pixels"},
      {"depth.cache_ways", "ways", power_of_two<&M::depth, &M::Depth::cache_ways>(1, 16), "its ways"},
      {"depth.pending", "quads", integer<&M::depth, &M::Depth::pending>(1, 4096),
       "quads waiting for their lines"},
      {"depth.latency", "clocks", integer<&M::depth, &M::Depth::latency>(1, 256), "through the depth test"},
      {"depth.queue", "quads", integer<&M::depth, &M::Depth::queue>(1, 1024),
       "quads in and behind the depth test"},
      {"depth.fast_clear", "", on_off<&M::depth, &M::Depth::fast_clear>(),
       "a clear marks depth lines as cleared in place of writing them"},
      {"texture.cache_lines", "lines", power_of_two<&M::texture, &M::Texture::cache_lines>(4, 65536),
       "texture cache"},
      {"texture.cache_ways", "ways", power_of_two<&M::texture, &M::Texture::cache_ways>(1, 16), "its ways"},
      {"texture.line_bytes", "bytes", power_of_two<&M::texture, &M::Texture::line_bytes>(16, 256),
       "its line: one or more blocks of 4x4 texels"},
      {"texture.fill_bytes", "bytes", power_of_two<&M::texture, &M::Texture::fill_bytes>(8, 256),
       "read on a miss: the line, or the part of it that the sample lies in"},
      {"texture.lookups_per_clock", "", integer<&M::texture, &M::Texture::lookups_per_clock>(1, 64),
       "texel blocks looked up a clock"},
      {"texture.pending", "quads", integer<&M::texture, &M::Texture::pending>(1, 4096),
       "quads waiting for their texels (the latency-hiding FIFO)"},
      {"texture.latency", "clocks", integer<&M::texture, &M::Texture::latency>(1, 256),
       "through the texture unit"},
      {"texture.queue", "quads", integer<&M::texture, &M::Texture::queue>(1, 1024),
       "quads in and behind the texture unit"},
      {"pixel.quads_per_clock", "quads", integer<&M::pixel, &M::Pixel::quads_per_clock>(1, 16),
       "2x2 quads a clock from rasteriser to blending: a quarter of the pixel pipes"},
      {"pixel.instructions_per_clock", "", integer<&M::pixel, &M::Pixel::instructions_per_clock>(1, 16),
       "halves of arithmetic instructions, colour or alpha, of the pixel program a clock, a pipe"},
      {"pixel.latency", "clocks", integer<&M::pixel, &M::Pixel::latency>(1, 256), "through the pixel unit"},
      {"pixel.queue", "quads", integer<&M::pixel, &M::Pixel::queue>(1, 1024),
       "quads in and behind the pixel unit"},
      {"blend.cache_lines", "lines", power_of_two<&M::blend, &M::Blend::cache_lines>(4, 65536),
       "colour cache, lines of 4x4 pixels"},
      {"blend.cache_ways", "ways", power_of_two<&M::blend, &M::Blend::cache_ways>(1, 16), "its ways"},
      {"blend.pending", "quads", integer<&M::blend, &M::Blend::pending>(1, 4096),
       "quads waiting for their lines"},
  };
}

std::vector<Parameter> memory_parameters() {
  return {
      {"memory.channels", "", power_of_two<&M::memory, &M::Memory::channels>(1, 16),
       "independent controllers"},
      {"memory.channel_bytes_per_clock", "bytes",
       power_of_two<&M::memory, &M::Memory::channel_bytes_per_clock>(1, 256),
       "a channel's data a clock, both edges"},
      {"memory.burst_bytes", "bytes", power_of_two<&M::memory, &M::Memory::burst_bytes>(8, 256),
       "least data of an access"},
      {"memory.interleave_bytes", "bytes", power_of_two<&M::memory, &M::Memory::interleave_bytes>(64, 65536),
       "consecutive addresses on one channel"},
      {"memory.banks", "", power_of_two<&M::memory, &M::Memory::banks>(1, 64),
       "banks a channel; the frame with its surfaces, the depths, each texture and buffer "
       "begin in the first"},
      {"memory.row_bytes", "bytes", power_of_two<&M::memory, &M::Memory::row_bytes>(256, 65536),
       "row of a bank"},
      {"memory.precharge_clocks", "clocks", integer<&M::memory, &M::Memory::precharge_clocks>(0, 256),
       "from precharge to activate (tRP)"},
      {"memory.activate_clocks", "clocks", integer<&M::memory, &M::Memory::activate_clocks>(0, 256),
       "from activate to read or write (tRCD)"},
      {"memory.cas_clocks", "clocks", integer<&M::memory, &M::Memory::cas_clocks>(1, 256),
       "from read or write to its first data (CL)"},
      {"memory.row_active_clocks", "clocks", integer<&M::memory, &M::Memory::row_active_clocks>(0, 256),
       "least from activate to precharge (tRAS)"},
      {"memory.write_recovery_clocks", "clocks",
       integer<&M::memory, &M::Memory::write_recovery_clocks>(0, 256),
       "from the last data of a write to precharge (tWR)"},
      {"memory.turnaround_clocks", "clocks", integer<&M::memory, &M::Memory::turnaround_clocks>(0, 256),
       "data bus, between a read and a write"},
      {"memory.request_queue", "requests", integer<&M::memory, &M::Memory::request_queue>(1, 1024),
       "from each unit to each channel"},
      {"memory.schedule_queue", "requests", integer<&M::memory, &M::Memory::schedule_queue>(1, 64),
       "that a channel picks from, open rows first"},
      {"memory.bypass_limit", "requests", integer<&M::memory, &M::Memory::bypass_limit>(0, 1024),
       "that may overtake the oldest"},
      {"memory.return_latency", "clocks", integer<&M::memory, &M::Memory::return_latency>(1, 1024),
       "from the last data of a read to the unit that asked: controller and crossbar, both ways"},
  };
}

std::vector<Parameter> host_parameters() {
  return {
      {"agp.bytes_per_clock", "bytes", integer<&M::agp, &M::Agp::bytes_per_clock>(1, 256),
       "a bus clock, reading host memory (AGP 4x: four 4-byte transfers)"},
      {"agp.latency_nanoseconds", "ns", real<&M::agp, &M::Agp::latency_nanoseconds>(0, 1e6),
       "from request to first data of host memory"},
      {"agp.queue", "requests", integer<&M::agp, &M::Agp::queue>(1, 1024), "requests on the bus"},
      {"host.command_nanoseconds", "ns", real<&M::host, &M::Host::command_nanoseconds>(0, 1e9),
       "driver and bus, before each command reaches the command processor"},
      {"host.uncached_read_nanoseconds", "ns", real<&M::host, &M::Host::uncached_read_nanoseconds>(0, 1e6),
       "one read of the frame buffer by the host, which waits for it"},
      {"host.uncached_read_bytes", "bytes", integer<&M::host, &M::Host::uncached_read_bytes>(1, 64),
       "that such a read brings"},
      {"host.division_nanoseconds", "ns", real<&M::host, &M::Host::division_nanoseconds>(0, 1e6),
       "to divide a pixel's colour by its weight"},
      {"host.write_bytes_per_clock", "bytes", integer<&M::host, &M::Host::write_bytes_per_clock>(1, 16),
       "a bus clock, writing the frame buffer (posted; each pixel begins a clock of its own)"},
  };
}

}  // namespace

std::span<const Parameter> parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> joined;
    for (const auto& group : {number_parameters(), geometry_parameters(), pixel_parameters(),
                              memory_parameters(), host_parameters()}) {
      joined.insert(joined.end(), group.begin(), group.end());
    }
    return joined;
  }();
  return all;
}

std::string_view name(FrameFormat format) {
  return kFrameFormats[static_cast<std::size_t>(format)];
}

}  // namespace splatscope::machine
