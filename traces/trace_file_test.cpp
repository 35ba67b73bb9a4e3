#include "traces/trace_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>

#include "model/error.h"
#include "model/testing/random_seed.h"
#include "model/testing/scratch_folder.h"
#include "traces/output_files.h"
#include "traces/trace_generated.h"

namespace splatscope::traces {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::StartsWith;

std::vector<std::byte> bytes_of(const fs::path& path) {
  const std::string text = text_of(path);
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

Draw small_draw() {
  Draw draw;
  draw.pixel_program = 1;
  draw.texture = 0;
  draw.vertex_stride = 20;
  draw.attributes = {{0, VertexFormat::float3, 0}, {5, VertexFormat::d3dcolor, 16}};
  draw.base_vertex = 1;
  draw.index_buffer = 1;
  draw.first_index = 1;
  draw.index_count = 6;
  draw.constants = {{1, 2, 3, 4}, {-0.0f, 1e-40f, std::numeric_limits<float>::infinity(), 7}};
  draw.state = {
      false, true, false, true, BlendFactor::src_alpha, BlendFactor::dst_color, CullMode::counter_clockwise};
  return draw;
}

// Every kind of command, and no value at its default.
Trace small_trace() {
  Trace trace;
  trace.width = 640;
  trace.height = 4096;
  trace.buffers = {{MemoryPlace::agp, std::vector<std::byte>(100, std::byte{7})}, {MemoryPlace::video, {}}};
  const std::uint16_t indices[] = {0xffff, 0, 1, 2, 2, 1, 3};  // the first is outside of the draw
  for (std::byte b : std::as_bytes(std::span(indices))) trace.buffers[1].bytes.push_back(b);
  trace.textures = {{3, 2, {1, 2, 3, 4, 5, 255}}};
  trace.programs = {{"a.vs", "vs_1_1\nmov oPos, v0\n"}, {"b.ps", "ps_1_1\ntex t0\nmul r0, v0, t0.a\n"}};
  trace.commands = {Clear{{0.25f, 0.5f, 0.75f, 1}, 0.5f}, small_draw(), NormalizeOnHost{}, Present{}};
  return trace;
}

void expect_equal(const Draw& a, const Draw& b) {
  EXPECT_EQ(a.vertex_program, b.vertex_program);
  EXPECT_EQ(a.pixel_program, b.pixel_program);
  EXPECT_EQ(a.texture, b.texture);
  EXPECT_EQ(a.target, b.target);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.vertex_buffer, b.vertex_buffer);
  EXPECT_EQ(a.vertex_stride, b.vertex_stride);
  EXPECT_EQ(a.attributes, b.attributes);
  EXPECT_EQ(a.base_vertex, b.base_vertex);
  EXPECT_EQ(a.index_buffer, b.index_buffer);
  EXPECT_EQ(a.first_index, b.first_index);
  EXPECT_EQ(a.index_count, b.index_count);
  ASSERT_EQ(a.constants.size(), b.constants.size());
  EXPECT_EQ(std::memcmp(a.constants.data(), b.constants.data(), a.constants.size() * sizeof(Vec4)), 0);
  EXPECT_EQ(a.state.depth_test, b.state.depth_test);
  EXPECT_EQ(a.state.depth_write, b.state.depth_write);
  EXPECT_EQ(a.state.color_write, b.state.color_write);
  EXPECT_EQ(a.state.blend, b.state.blend);
  EXPECT_EQ(a.state.source_factor, b.state.source_factor);
  EXPECT_EQ(a.state.destination_factor, b.state.destination_factor);
  EXPECT_EQ(a.state.cull, b.state.cull);
}

void expect_equal(const Trace& a, const Trace& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  ASSERT_EQ(a.buffers.size(), b.buffers.size());
  for (std::size_t i = 0; i < a.buffers.size(); ++i) {
    EXPECT_EQ(a.buffers[i].place, b.buffers[i].place);
    EXPECT_EQ(a.buffers[i].bytes, b.buffers[i].bytes);
  }
  ASSERT_EQ(a.textures.size(), b.textures.size());
  for (std::size_t i = 0; i < a.textures.size(); ++i) {
    EXPECT_EQ(a.textures[i].width, b.textures[i].width);
    EXPECT_EQ(a.textures[i].height, b.textures[i].height);
    EXPECT_EQ(a.textures[i].texels, b.textures[i].texels);
  }
  ASSERT_EQ(a.programs.size(), b.programs.size());
  for (std::size_t i = 0; i < a.programs.size(); ++i) {
    EXPECT_EQ(a.programs[i].name, b.programs[i].name);
    EXPECT_EQ(a.programs[i].text, b.programs[i].text);
  }
  ASSERT_EQ(a.commands.size(), b.commands.size());
  for (std::size_t i = 0; i < a.commands.size(); ++i) {
    ASSERT_EQ(a.commands[i].index(), b.commands[i].index());
    if (const auto* clear = std::get_if<Clear>(&a.commands[i])) {
      EXPECT_EQ(clear->color, std::get<Clear>(b.commands[i]).color);
      EXPECT_EQ(clear->depth, std::get<Clear>(b.commands[i]).depth);
    }
    if (const auto* draw = std::get_if<Draw>(&a.commands[i]))
      expect_equal(*draw, std::get<Draw>(b.commands[i]));
  }
}

class TraceFile : public testing::Test {
 protected:
  ScratchFolder folder_;
  fs::path path_ = folder_ / "test.trace";
};

TEST_F(TraceFile, WhatIsWrittenIsReadBack) {
  write_trace(small_trace(), path_);
  expect_equal(small_trace(), read_trace(path_));
}

// A file that the first version wrote: no culling, no frames.
TEST_F(TraceFile, FilesOfVersion1AreRead) {
  Trace trace = small_trace();
  std::get<Draw>(trace.commands[1]).state.cull = CullMode::none;
  trace.commands.pop_back();
  expect_equal(trace, read_trace(SPLATSCOPE_SOURCE "/tests/traces/version_1.trace"));
}

// A draw into an off-screen surface, and one that samples it.
Trace trace_with_surface() {
  Trace trace = small_trace();
  trace.surfaces = 2;
  Draw into = small_draw(), from = small_draw();
  into.target = 2;
  into.state.depth_write = false;
  from.source = 2;
  from.texture.reset();
  trace.commands = {into, from};
  return trace;
}

TEST_F(TraceFile, SurfacesAreWrittenAndReadBack) {
  write_trace(trace_with_surface(), path_);
  const Trace trace = read_trace(path_);
  expect_equal(trace_with_surface(), trace);
  EXPECT_EQ(trace.surfaces, 2u);
}

TEST_F(TraceFile, SurfacesThatCannotBeDrawnAreRefused) {
  const auto refused = [](const std::function<void(Trace&, Draw & into, Draw & from)>& change) {
    Trace trace = trace_with_surface();
    change(trace, std::get<Draw>(trace.commands[0]), std::get<Draw>(trace.commands[1]));
    EXPECT_THROW(check_trace(trace, "changed"), UserError);
  };
  refused([](Trace& trace, Draw&, Draw&) { trace.surfaces = 1000; });
  refused([](Trace&, Draw& into, Draw&) { into.target = 3; });
  refused([](Trace&, Draw& into, Draw&) { into.state.depth_test = true; });
  refused([](Trace&, Draw& into, Draw&) { into.state.depth_write = true; });
  refused([](Trace&, Draw&, Draw& from) { from.source = 0; });
  refused([](Trace&, Draw&, Draw& from) { from.source = 3; });
  refused([](Trace&, Draw&, Draw& from) { from.texture = 0; });
  refused([](Trace&, Draw& into, Draw&) {
    into.texture.reset();
    into.source = 2;
  });
}

TEST_F(TraceFile, AbsentProgramAndTextureStayAbsent) {
  Trace trace = small_trace();
  std::get<Draw>(trace.commands[1]).pixel_program.reset();
  std::get<Draw>(trace.commands[1]).texture.reset();
  write_trace(trace, path_);
  expect_equal(trace, read_trace(path_));
}

TEST_F(TraceFile, AnyTruncationIsRefused) {
  write_trace(small_trace(), path_);
  const std::vector<std::byte> whole = bytes_of(path_);
  for (std::size_t size = 0; size < whole.size(); size += 16) {
    write_file(path_, std::span(whole).first(size));
    EXPECT_THROW(read_trace(path_), UserError) << size << " of " << whole.size() << " bytes";
  }
}

// A changed byte may still be a valid trace; it may never do harm, and what is let in keeps every rule.
TEST_F(TraceFile, MutationsAreRefusedOrHarmless) {
  write_trace(small_trace(), path_);
  const std::vector<std::byte> whole = bytes_of(path_);
  std::mt19937 random(random_seed());
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::byte> mutant = whole;
    for (unsigned flips = 1 + random() % 4; flips > 0; --flips)
      mutant[random() % mutant.size()] = static_cast<std::byte>(random());
    write_file(path_, mutant);
    try {
      check_trace(read_trace(path_), "mutant");
    } catch (const UserError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST_F(TraceFile, NewerVersionIsRefusedByName) {
  write_trace(small_trace(), path_);
  std::vector<std::byte> bytes = bytes_of(path_);
  auto* root = flatbuffers::GetMutableRoot<flatbuffers::Table>(bytes.data());
  ASSERT_TRUE(root->SetField<std::uint32_t>(stored::Trace::VT_VERSION, kTraceVersion + 1, 0));
  write_file(path_, bytes);
  EXPECT_THAT(error_of([&] { read_trace(path_); }),
              HasSubstr("version 4, expected 1 to 3 (a newer splatscope wrote it)"));
}

// A few bytes must not unfold to gigabytes: many entries that name one and the same buffer.
TEST_F(TraceFile, SharedBytesAreRefused) {
  flatbuffers::FlatBufferBuilder builder;
  const auto bytes = builder.CreateVector(std::vector<std::uint8_t>(1 << 16));
  const auto buffer = stored::CreateBuffer(builder, stored::MemoryPlace::video, bytes);
  const auto buffers = builder.CreateVector(std::vector(8192, buffer));
  const auto textures = builder.CreateVector(std::vector<flatbuffers::Offset<stored::Texture>>{});
  const auto programs = builder.CreateVector(std::vector<flatbuffers::Offset<stored::Program>>{});
  const auto commands = builder.CreateVector(std::vector<flatbuffers::Offset<stored::Command>>{});
  stored::FinishTraceBuffer(
      builder, stored::CreateTrace(builder, kTraceVersion, 8, 8, buffers, textures, programs, commands));
  write_file(path_, std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize())));
  EXPECT_THAT(error_of([&] { read_trace(path_); }), HasSubstr("the same bytes twice"))
      << "512 MiB out of 96 KiB";
}

TEST_F(TraceFile, WhatIsNoTraceIsRefused) {
  EXPECT_THROW(read_trace(folder_ / "missing.trace"), UserError);
  EXPECT_THROW(read_trace(folder_.path()), UserError);
  write_file(path_, "surely not a trace");
  EXPECT_THROW(read_trace(path_), UserError);
}

TEST_F(TraceFile, UnwritablePlaceIsTheUsersError) {
  EXPECT_THROW(write_trace(small_trace(), folder_ / "missing-folder" / "x.trace"), UserError);
}

struct Breakage {
  const char* name;
  std::function<void(Trace&, Draw&)> apply;
  const char* message;
};

std::vector<Breakage> breakages() {
  return {
      {"no width", [](Trace& t, Draw&) { t.width = 0; }, "frame: width is 0, expected 1 to 4096"},
      {"height", [](Trace& t, Draw&) { t.height = 4097; }, "height is 4097"},
      {"place", [](Trace& t, Draw&) { t.buffers[1].place = MemoryPlace(2); }, "buffer 1: memory place is 2"},
      {"texels", [](Trace& t, Draw&) { t.textures[0].texels.pop_back(); }, "5 bytes of texels, expected 6"},
      {"texture", [](Trace& t, Draw&) { t.textures[0].width = 0; }, "texture 0: width is 0"},
      {"clear nan", [](Trace& t, Draw&) { std::get<Clear>(t.commands[0]).color[2] = NAN; },
       "clear color is nan"},
      {"clear depth", [](Trace& t, Draw&) { std::get<Clear>(t.commands[0]).depth = 2; }, "clear depth is 2"},
      {"escape", [](Trace& t, Draw&) { t.programs[1].name = "\x1b[2J.ps"; },
       "program 1: control characters in its name, expected a name on one line"},
      {"program", [](Trace& t, Draw&) { t.programs[1].text = "ps_1_1\nmov r9, v0\n"; }, "program 1: b.ps:2:"},
      {"pixel as vertex", [](Trace&, Draw& d) { d.vertex_program = 1; }, "program 1 is of the other kind"},
      {"vertex as pixel", [](Trace&, Draw& d) { d.pixel_program = 0; }, "expected a pixel program"},
      {"no texture", [](Trace&, Draw& d) { d.texture.reset(); }, "samples a texture and the draw has none"},
      {"stage 1", [](Trace& t, Draw&) { t.programs[1].text = "ps_1_1\ntex t1\nmov r0, t1\n"; },
       "a texture stage above 0"},
      {"vs", [](Trace&, Draw& d) { d.vertex_program = 2; }, "vertex program 2 does not exist"},
      {"ps", [](Trace&, Draw& d) { d.pixel_program = 9; }, "pixel program 9 does not exist"},
      {"which texture", [](Trace&, Draw& d) { d.texture = 1; }, "texture 1 does not exist"},
      {"vb", [](Trace&, Draw& d) { d.vertex_buffer = 2; }, "vertex buffer 2 does not exist"},
      {"ib", [](Trace&, Draw& d) { d.index_buffer = 2; }, "index buffer 2 does not exist"},
      {"stride 0", [](Trace&, Draw& d) { d.vertex_stride = 0; }, "vertex stride is 0"},
      {"stride", [](Trace&, Draw& d) { d.vertex_stride = 19; }, "attribute of v5 ends at byte 20"},
      {"no attribute", [](Trace&, Draw& d) { d.attributes.clear(); }, "number of attributes is 0"},
      {"input", [](Trace&, Draw& d) { d.attributes[0].input = 16; }, "input register is 16"},
      {"twice", [](Trace&, Draw& d) { d.attributes[0].input = 5; }, "v5 is given twice"},
      {"format", [](Trace&, Draw& d) { d.attributes[0].format = VertexFormat(8); }, "format is 8"},
      {"offset", [](Trace&, Draw& d) { d.attributes[0].offset = 65535; },
       "attribute of v0 ends at byte 65547"},
      {"triangles", [](Trace&, Draw& d) { d.index_count = 5; }, "5 indices, expected a multiple of 3"},
      {"indices", [](Trace&, Draw& d) { d.first_index = 2; }, "indices end at 8"},
      {"wrap", [](Trace&, Draw& d) { d.first_index = 0xfffffffd; }, "indices end at 4294967299"},
      {"index", [](Trace&, Draw& d) { d.first_index = 0; }, "vertex 65536 does not exist"},
      {"base", [](Trace&, Draw& d) { d.base_vertex = 2; }, "vertex 5 does not exist, expected one of the 5"},
      {"base wrap", [](Trace&, Draw& d) { d.base_vertex = 0xffffffff; }, "vertex 4294967298 does not exist"},
      {"constants", [](Trace&, Draw& d) { d.constants.resize(97); }, "number of constants is 97"},
      {"source", [](Trace&, Draw& d) { d.state.source_factor = BlendFactor(11); },
       "source blend factor is 11"},
      {"cull", [](Trace&, Draw& d) { d.state.cull = CullMode(3); }, "cull mode is 3, expected 0 to 2"},
      {"frames", [](Trace& t, Draw&) { t.commands.resize(t.commands.size() + 1000, Present{}); },
       "broken.trace: frame: number of frames is 1001, expected 1 to 1000"},
      {"dest", [](Trace&, Draw& d) { d.state.destination_factor = BlendFactor(255); }, "blend factor is 255"},
  };
}

// Each broken rule is found in memory, and in a file that some other program wrote.
TEST(TraceCheck, EachRuleIsChecked) {
  EXPECT_NO_THROW(check_trace(small_trace(), "whole"));
  for (const Breakage& breakage : breakages()) {
    Trace trace = small_trace();
    breakage.apply(trace, std::get<Draw>(trace.commands[1]));
    EXPECT_THAT(error_of([&] { check_trace(trace, "broken.trace"); }),
                AllOf(StartsWith("broken.trace: "), HasSubstr(breakage.message), HasSubstr("expected")))
        << breakage.name;
  }
}

TEST(OutputFile, LeavesNothingWithoutCommit) {
  const ScratchFolder folder;
  { OutputFile file(folder / "a.txt"); }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  write_file(folder / "a.txt", "whole");
  EXPECT_EQ(bytes_of(folder / "a.txt").size(), 5u);
  EXPECT_EQ(folder.names().size(), 1u);
}

// As long as the system lets it be: the temporary one is no longer.
TEST(OutputFile, HasANameOfAnyLength) {
  const ScratchFolder folder;
  write_file(folder / std::string(255, 'n'), "long");
  EXPECT_EQ("long", text_of(folder / std::string(255, 'n')));
  EXPECT_THAT(error_of([&] { write_file(folder / std::string(256, 'n'), "longer"); }),
              HasSubstr("nn: is too long a name, expected a shorter one"));
  EXPECT_EQ(1u, folder.names().size());
}

TEST(OutputFile, GoesWhereALinkPoints) {
  const ScratchFolder folder;
  write_file(folder / "a.txt", "there");
  fs::create_symlink("a.txt", folder / "soft.txt");
  write_file(folder / "soft.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "soft.txt"));
  EXPECT_EQ(text_of(folder / "a.txt"), "new");
}

TEST(OutputFiles, OfOneNameAreToldApart) {
  const ScratchFolder folder;
  fs::create_directory(folder / "below");
  write_file(folder / "a.txt", "there");
  fs::create_hard_link(folder / "a.txt", folder / "hard.txt");
  fs::create_symlink("a.txt", folder / "soft.txt");
  fs::create_directory_symlink("below", folder / "link");
  const auto apart = [&](const fs::path& a, const fs::path& b) {
    const std::string error = error_of([&] { expect_apart({{"-o", a}}, {{"FILE", b}}); });
    if (error == "no error") return true;
    EXPECT_EQ(error, fmt::format("{}: is named by -o and by FILE ({}), expected a file of its own for each",
                                 a.string(), b.string()));
    return false;
  };
  for (const char* name : {"a.txt", "below/../a.txt", "hard.txt", "soft.txt", "link/../a.txt"})
    EXPECT_FALSE(apart(folder / name, folder / "a.txt")) << name;
  EXPECT_FALSE(apart(folder / "link" / "new.txt", folder / "below" / "new.txt"));
  EXPECT_FALSE(apart("new.txt", fs::absolute("new.txt")));
  EXPECT_TRUE(apart(folder / "new.txt", folder / "below" / "new.txt"));
  EXPECT_TRUE(apart(folder / "new.txt", folder / "a.txt"));
  EXPECT_TRUE(apart("", ""));  // no file at all
}

TEST(OutputFolder, StaysOnlyWithFilesInIt) {
  const ScratchFolder scratch;
  const fs::path outer = scratch / "outer";
  { OutputFolder folder(outer / "a" / "b"); }
  EXPECT_FALSE(fs::exists(outer));
  {
    OutputFolder folder(outer / "a" / "b/");
    EXPECT_TRUE(fs::is_directory(folder.path()));
    write_file(outer / "a" / "c.txt", "whole");
  }
  EXPECT_FALSE(fs::exists(outer / "a" / "b"));
  EXPECT_TRUE(fs::exists(outer / "a" / "c.txt"));
  fs::create_directory(outer / "empty");
  { OutputFolder folder(outer / "empty"); }
  EXPECT_TRUE(fs::exists(outer / "empty"));  // it was there before
  EXPECT_THROW(OutputFolder(outer / "a" / "c.txt"), UserError);
  EXPECT_THROW(OutputFolder(outer / "a" / "c.txt" / "d"), UserError);
}

}  // namespace
}  // namespace splatscope::traces
