#include <cstring>
#include <limits>

#include "cases.h"
#include "traces/trace_file.h"

namespace splatscope::tests {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kHuge = 0xffffffffu;

std::string text_of_trace(const Trace& trace) {
  const std::vector<std::byte> bytes = traces::trace_bytes(trace, "trace");
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Records in a process of its own: no thread may start in this one.
Trace small_trace(const BadInputs& inputs) {
  Forked({"record", "small.toml", "-o", "small.trace"}, inputs.path()).outcome();
  return traces::read_trace(inputs.path() / "small.trace");
}

Draw& draw_of(Trace& trace) {
  for (Command& command : trace.commands)
    if (Draw* draw = std::get_if<Draw>(&command)) return *draw;
  throw std::runtime_error("no draw");
}

struct Change {
  const char* what;
  void (*apply)(Trace&);
};

// A rule of the format broken by each.
constexpr Change kChanges[] = {
    {"no width", [](Trace& t) { t.width = 0; }},
    {"a width of 2^32 - 1", [](Trace& t) { t.width = kHuge; }},
    {"a height of 4097", [](Trace& t) { t.height = 4097; }},
    {"a texture without texels", [](Trace& t) { t.textures.at(0).texels.clear(); }},
    {"a texture of 2^32 - 1 texels a side",
     [](Trace& t) { t.textures.at(0).width = t.textures.at(0).height = kHuge; }},
    {"a texture of 65536 x 65536, which is 0 in 32 bits",
     [](Trace& t) { t.textures.at(0).width = t.textures.at(0).height = 65536; }},
    {"a program that is none", [](Trace& t) { t.programs.at(0).text = "\x01\x02 no program"; }},
    {"an empty program", [](Trace& t) { t.programs.at(0).text.clear(); }},
    {"a program of a later version", [](Trace& t) { t.programs.at(0).text = "vs_3_0\nmov oPos, v0\n"; }},
    {"no programs", [](Trace& t) { t.programs.clear(); }},
    {"no buffers", [](Trace& t) { t.buffers.clear(); }},
    {"empty buffers", [](Trace& t) { t.buffers.assign(t.buffers.size(), {}); }},
    {"no textures", [](Trace& t) { t.textures.clear(); }},
    {"a place of memory that there is not", [](Trace& t) { t.buffers.at(0).place = MemoryPlace{9}; }},
    {"1001 frames", [](Trace& t) { t.commands.assign(1001, Present{}); }},
    {"a clear colour NaN",
     [](Trace& t) {
       t.commands.insert(t.commands.begin(), Clear{{kNaN, 0, 0, 0}, 1});
     }},
    {"a clear depth INF",
     [](Trace& t) {
       t.commands.insert(t.commands.begin(), Clear{{}, kInfinity});
     }},
    {"a clear depth of -1",
     [](Trace& t) {
       t.commands.insert(t.commands.begin(), Clear{{}, -1});
     }},
    {"a vertex program that does not exist", [](Trace& t) { draw_of(t).vertex_program = kHuge; }},
    {"a pixel program that does not exist", [](Trace& t) { draw_of(t).pixel_program = kHuge; }},
    {"a vertex program as pixel program",
     [](Trace& t) { draw_of(t).pixel_program = draw_of(t).vertex_program; }},
    {"a texture that does not exist", [](Trace& t) { draw_of(t).texture = kHuge; }},
    {"a vertex buffer that does not exist", [](Trace& t) { draw_of(t).vertex_buffer = kHuge; }},
    {"an index buffer that does not exist", [](Trace& t) { draw_of(t).index_buffer = kHuge; }},
    {"a stride of 0", [](Trace& t) { draw_of(t).vertex_stride = 0; }},
    {"a stride of 2^32 - 1", [](Trace& t) { draw_of(t).vertex_stride = kHuge; }},
    {"no attributes", [](Trace& t) { draw_of(t).attributes.clear(); }},
    {"1000 attributes", [](Trace& t) { draw_of(t).attributes.resize(1000); }},
    {"an input register v200", [](Trace& t) { draw_of(t).attributes.at(0).input = 200; }},
    {"an input register twice",
     [](Trace& t) { draw_of(t).attributes.push_back(draw_of(t).attributes.front()); }},
    {"an attribute beyond the stride", [](Trace& t) { draw_of(t).attributes.at(0).offset = 65535; }},
    {"a format that there is not", [](Trace& t) { draw_of(t).attributes.at(0).format = VertexFormat{99}; }},
    {"a base vertex of 2^32 - 1", [](Trace& t) { draw_of(t).base_vertex = kHuge; }},
    {"a first index of 2^32 - 1", [](Trace& t) { draw_of(t).first_index = kHuge; }},
    {"2^32 - 1 indices", [](Trace& t) { draw_of(t).index_count = kHuge; }},
    {"two indices", [](Trace& t) { draw_of(t).index_count = 2; }},
    {"97 constants", [](Trace& t) { draw_of(t).constants.resize(97); }},
    {"a blend factor that there is not", [](Trace& t) { draw_of(t).state.source_factor = BlendFactor{77}; }},
    {"a cull mode that there is not", [](Trace& t) { draw_of(t).state.cull = CullMode{7}; }},
};

TEST(BadInputs, TracesCutShort) {
  BadInputs inputs;
  inputs.file("small.toml", kTinyScene);
  const std::string whole = text_of_trace(small_trace(inputs));
  inputs.cut("cut.trace", whole, [&](const std::string& what) {
    inputs.refused(what, {"trace", "info", "cut.trace"});
  });
  EXPECT_GE(inputs.count(), 100);
  inputs.file("cut.trace", whole.substr(0, whole.size() - 1));
  inputs.refused("all but a byte", {"run", "cut.trace"});
  inputs.refused("all but a byte", {"explain", "cut.trace", "--pixel", "1,1"});
  inputs.refused("all but a byte", {"sweep", "cut.trace", "--sweep", "vertex.units=1,2"});
}

TEST(BadInputs, TracesThatBreakARule) {
  BadInputs inputs;
  inputs.file("small.toml", kTinyScene);
  const Trace whole = small_trace(inputs);
  for (const Change& change : kChanges) {
    Trace trace = whole;
    change.apply(trace);
    inputs.file("bad.trace", text_of_trace(trace));
    inputs.refused(change.what, {"run", "bad.trace", "--fidelity", "functional"});
  }
}

template <class Value>
Value value_at(const char* place) {
  Value value;
  std::memcpy(&value, place, sizeof value);
  return value;
}

// Where the version stands (docs/trace_format.md): the first field of the first table.
char* version_of(std::string& file) {
  char* table = file.data() + value_at<std::uint32_t>(file.data());
  const char* fields = table - value_at<std::int32_t>(table);
  return table + value_at<std::uint16_t>(fields + 4);
}

TEST(BadInputs, TracesOfAnotherVersion) {
  BadInputs inputs;
  inputs.file("small.toml", kTinyScene);
  std::string bytes = text_of_trace(small_trace(inputs));
  char* version = version_of(bytes);
  for (const std::uint32_t other : {0u, traces::kTraceVersion + 1, 1000u, 0x7fffffffu, kHuge}) {
    std::memcpy(version, &other, sizeof other);
    inputs.file("other.trace", bytes);
    inputs.refused(fmt::format("version {}", other), {"trace", "info", "other.trace"});
  }
  for (const char* identifier : {"SPLX", "splt", "\0\0\0\0"}) {
    bytes.replace(4, 4, identifier, 4);
    inputs.file("other.trace", bytes);
    inputs.refused("another identifier", {"trace", "info", "other.trace"});
  }
}

// A file that says it is as long as nothing that a trace holds: found before memory is taken for it.
TEST(BadInputs, TracesOfAbsurdSize) {
  BadInputs inputs;
  for (const std::uintmax_t gibibytes : {std::uintmax_t{1}, std::uintmax_t{3}, std::uintmax_t{1000}}) {
    inputs.file("large.trace", "");
    std::error_code error;
    std::filesystem::resize_file(inputs.path() / "large.trace", gibibytes << 30, error);
    if (!error) inputs.refused(fmt::format("{} GiB of zeros", gibibytes), {"run", "large.trace"});
  }
}

}  // namespace
}  // namespace splatscope::tests
