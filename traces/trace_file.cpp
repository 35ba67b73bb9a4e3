#include "traces/trace_file.h"

#include <fmt/format.h>

#include <array>
#include <fstream>

#include "model/error.h"
#include "traces/output_files.h"
#include "traces/trace_generated.h"

namespace splatscope::traces {
namespace {

namespace fb = flatbuffers;

// ---- writing

fb::Offset<stored::Draw> pack(fb::FlatBufferBuilder& builder, const Draw& draw) {
  std::vector<fb::Offset<stored::Attribute>> attributes;
  for (const VertexAttribute& a : draw.attributes)
    attributes.push_back(
        stored::CreateAttribute(builder, a.input, static_cast<stored::VertexFormat>(a.format), a.offset));
  std::vector<stored::Vec4> constants;
  for (const Vec4& c : draw.constants) constants.emplace_back(c[0], c[1], c[2], c[3]);
  const auto packed_attributes = builder.CreateVector(attributes);
  const auto packed_constants = builder.CreateVectorOfStructs(constants);
  const DrawState& s = draw.state;
  const auto state = stored::CreateDrawState(builder, s.depth_test, s.depth_write, s.color_write, s.blend,
                                             static_cast<stored::BlendFactor>(s.source_factor),
                                             static_cast<stored::BlendFactor>(s.destination_factor),
                                             static_cast<stored::CullMode>(s.cull));
  stored::DrawBuilder out(builder);
  out.add_vertex_program(draw.vertex_program);
  if (draw.pixel_program) out.add_pixel_program(*draw.pixel_program);
  if (draw.texture) out.add_texture(*draw.texture);
  out.add_vertex_buffer(draw.vertex_buffer);
  out.add_vertex_stride(draw.vertex_stride);
  out.add_attributes(packed_attributes);
  out.add_base_vertex(draw.base_vertex);
  out.add_index_buffer(draw.index_buffer);
  out.add_first_index(draw.first_index);
  out.add_index_count(draw.index_count);
  out.add_constants(packed_constants);
  out.add_state(state);
  out.add_target(draw.target);
  if (draw.source) out.add_source(*draw.source);
  return out.Finish();
}

fb::Offset<stored::Clear> pack(fb::FlatBufferBuilder& builder, const Clear& clear) {
  const stored::Vec4 color(clear.color[0], clear.color[1], clear.color[2], clear.color[3]);
  return stored::CreateClear(builder, &color, clear.depth);
}

fb::Offset<stored::NormalizeOnHost> pack(fb::FlatBufferBuilder& builder, const NormalizeOnHost&) {
  return stored::CreateNormalizeOnHost(builder);
}

fb::Offset<stored::Present> pack(fb::FlatBufferBuilder& builder, const Present&) {
  return stored::CreatePresent(builder);
}

template <class Body>
fb::Offset<stored::Command> stored_command(fb::FlatBufferBuilder& builder, fb::Offset<Body> body) {
  return stored::CreateCommand(builder, stored::CommandBodyTraits<Body>::enum_value, body.Union());
}

void pack(fb::FlatBufferBuilder& builder, const Trace& trace) {
  std::vector<fb::Offset<stored::Buffer>> buffers;
  for (const Buffer& b : trace.buffers)
    buffers.push_back(stored::CreateBuffer(
        builder, static_cast<stored::MemoryPlace>(b.place),
        builder.CreateVector(reinterpret_cast<const std::uint8_t*>(b.bytes.data()), b.bytes.size())));
  std::vector<fb::Offset<stored::Texture>> textures;
  for (const Texture& t : trace.textures)
    textures.push_back(stored::CreateTexture(builder, t.width, t.height, builder.CreateVector(t.texels)));
  std::vector<fb::Offset<stored::Program>> programs;
  for (const ShaderText& p : trace.programs)
    programs.push_back(
        stored::CreateProgram(builder, builder.CreateString(p.name), builder.CreateString(p.text)));
  std::vector<fb::Offset<stored::Command>> commands;
  for (const Command& command : trace.commands)
    commands.push_back(
        std::visit([&](const auto& body) { return stored_command(builder, pack(builder, body)); }, command));
  const auto root =
      stored::CreateTrace(builder, kTraceVersion, trace.width, trace.height, builder.CreateVector(buffers),
                          builder.CreateVector(textures), builder.CreateVector(programs),
                          builder.CreateVector(commands), trace.surfaces);
  stored::FinishTraceBuffer(builder, root);
}

// Bytes of everything whose size the trace decides. The rest is small and counted generously.
std::size_t stored_size(const Trace& trace) {
  constexpr std::size_t kEach = 512;  // tables, offsets, alignment
  std::size_t size = kEach;
  for (const Buffer& b : trace.buffers) size += kEach + b.bytes.size();
  for (const Texture& t : trace.textures) size += kEach + t.texels.size();
  for (const ShaderText& p : trace.programs) size += kEach + p.name.size() + p.text.size();
  constexpr std::size_t kCommand = 4096;  // more than 96 constants and 16 attributes
  return size + kCommand * trace.commands.size();
}

// Its stored_size, which a file of FlatBuffers can have.
std::size_t expect_storable(const Trace& trace, std::string_view name) {
  const std::size_t size = stored_size(trace);
  if (size >= FLATBUFFERS_MAX_BUFFER_SIZE)
    throw UserError(name, 0, fmt::format("the trace would take {} bytes, expected less than 2 GiB", size));
  return size;
}

// ---- reading

// Unpacks a verified file. A hostile file may name the same bytes many times; what is copied out may
// therefore not exceed what the file holds.
class Reader {
 public:
  Reader(std::string_view file, std::size_t file_size) : file_(file), budget_(file_size) {}

  Trace unpack(const stored::Trace& in) {
    Trace trace;
    trace.width = in.width();
    trace.height = in.height();
    trace.surfaces = in.surfaces();
    for (const stored::Buffer* b : *in.buffers()) {
      spend(b->bytes()->size());
      Buffer& buffer = trace.buffers.emplace_back();
      buffer.place = static_cast<MemoryPlace>(b->place());
      const auto* bytes = reinterpret_cast<const std::byte*>(b->bytes()->data());
      buffer.bytes.assign(bytes, bytes + b->bytes()->size());
    }
    for (const stored::Texture* t : *in.textures()) {
      spend(t->texels()->size());
      trace.textures.push_back({t->width(), t->height(), {t->texels()->begin(), t->texels()->end()}});
    }
    for (const stored::Program* p : *in.programs()) {
      spend(p->name()->size() + p->text()->size());
      trace.programs.push_back({p->name()->str(), p->text()->str()});
    }
    for (const stored::Command* c : *in.commands()) trace.commands.push_back(unpack(*c));
    return trace;
  }

 private:
  void spend(std::size_t bytes) {
    if (bytes > budget_) throw UserError(file_, 0, "holds the same bytes twice, expected a trace file");
    budget_ -= bytes;
  }

  static Vec4 unpack(const stored::Vec4& v) { return {v.x(), v.y(), v.z(), v.w()}; }

  Command unpack(const stored::Command& command) {
    if (const stored::Clear* clear = command.body_as_Clear())
      return Clear{unpack(*clear->color()), clear->depth()};
    if (const stored::Draw* draw = command.body_as_Draw()) return unpack(*draw);
    if (command.body_as_NormalizeOnHost()) return NormalizeOnHost{};
    if (command.body_as_Present()) return Present{};
    throw UserError(file_, 0, "holds an unknown command, expected clear, draw, normalize or present");
  }

  Draw unpack(const stored::Draw& in) {
    Draw draw;
    draw.vertex_program = in.vertex_program();
    draw.pixel_program = in.pixel_program();
    draw.texture = in.texture();
    draw.target = in.target();
    draw.source = in.source();
    draw.vertex_buffer = in.vertex_buffer();
    draw.vertex_stride = in.vertex_stride();
    draw.base_vertex = in.base_vertex();
    draw.index_buffer = in.index_buffer();
    draw.first_index = in.first_index();
    draw.index_count = in.index_count();
    for (const stored::Attribute* a : *in.attributes()) {
      spend(sizeof(VertexAttribute));
      draw.attributes.push_back({a->input(), static_cast<VertexFormat>(a->format()), a->offset()});
    }
    if (in.constants()) {
      spend(in.constants()->size() * sizeof(Vec4));
      for (const stored::Vec4* c : *in.constants()) draw.constants.push_back(unpack(*c));
    }
    const stored::DrawState& s = *in.state();
    draw.state = {s.depth_test(),
                  s.depth_write(),
                  s.color_write(),
                  s.blend(),
                  static_cast<BlendFactor>(s.source_factor()),
                  static_cast<BlendFactor>(s.destination_factor()),
                  static_cast<CullMode>(s.cull())};
    return draw;
  }

  std::string_view file_;
  std::size_t budget_;
};

[[noreturn]] void fail_for_identifier(std::string_view file) {
  throw UserError(file, 0, "is no trace (its bytes 4 to 7 are not \"SPLT\"), expected a trace file");
}

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream in(path, std::ios::binary);
  if (error || !in) throw UserError(path.string(), 0, "cannot be read, expected a trace file");
  if (size >= FLATBUFFERS_MAX_BUFFER_SIZE)
    throw UserError(path.string(), 0, "is larger than 2 GiB, expected a trace file");
  std::array<std::uint8_t, 8> start{};  // before memory is taken for the rest
  in.read(reinterpret_cast<char*>(start.data()), start.size());
  if (!in || !stored::TraceBufferHasIdentifier(start.data())) fail_for_identifier(path.string());
  std::vector<std::uint8_t> bytes(size);
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) throw UserError(path.string(), 0, "ended while it was read, expected a trace file");
  return bytes;
}

}  // namespace

void write_trace(const Trace& trace, const std::filesystem::path& path) {
  check_trace(trace, path.string());
  fb::FlatBufferBuilder builder(expect_storable(trace, path.string()));
  pack(builder, trace);
  write_file(path, std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize())));
}

std::vector<std::byte> trace_bytes(const Trace& trace, std::string_view name) {
  fb::FlatBufferBuilder builder(expect_storable(trace, name));
  pack(builder, trace);
  const auto bytes = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
  return {bytes.begin(), bytes.end()};
}

Trace read_trace(const std::filesystem::path& path) {
  return trace_of_bytes(read_bytes(path), path.string());
}

Trace trace_of_bytes(std::span<const std::uint8_t> bytes, std::string_view file) {
  if (bytes.size() < 8 || !stored::TraceBufferHasIdentifier(bytes.data())) fail_for_identifier(file);
  // A table takes at least 8 bytes, so an honest file has no more of them; the limit bounds the time taken.
  constexpr fb::uoffset_t kDepth = 8;
  fb::Verifier verifier(bytes.data(), bytes.size(), kDepth, static_cast<fb::uoffset_t>(bytes.size() / 8));
  if (!stored::VerifyTraceBuffer(verifier))
    throw UserError(file, 0,
                    "is damaged, cut short or without a required field, expected a whole trace file");
  const stored::Trace& stored_trace = *stored::GetTrace(bytes.data());
  if (stored_trace.version() == 0 || stored_trace.version() > kTraceVersion)
    throw UserError(
        file, 0,
        fmt::format("is a trace of version {}, expected 1 to {}{}", stored_trace.version(), kTraceVersion,
                    stored_trace.version() > kTraceVersion ? " (a newer splatscope wrote it)" : ""));
  Trace trace = Reader(file, bytes.size()).unpack(stored_trace);
  check_trace(trace, file);
  return trace;
}

}  // namespace splatscope::traces
