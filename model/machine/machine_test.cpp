#include "model/machine/machine.h"

#include <gtest/gtest.h>

#include "model/error.h"
#include "model/machine/parameters.h"
#include "model/testing/error_of.h"

namespace splatscope::machine {
namespace {

std::string message_of(std::string_view text) {
  return error_of([&] { parse(text, "m.toml"); });
}

std::string set_message(std::string_view assignment) {
  Machine machine;
  return error_of([&] { set(machine, assignment); });
}

TEST(Machine, BuiltInFilesGiveEveryParameterWithItsSource) {
  ASSERT_EQ(built_in_names().size(), 2u);
  for (const auto name : built_in_names()) {
    int fitted = 0;
    for (const auto& value : describe(load(name))) {
      EXPECT_NE(value.origin.confidence, "default") << name << " " << value.name;
      EXPECT_FALSE(value.origin.source.empty()) << name << " " << value.name;
      EXPECT_EQ(value.origin.confidence == "fitted", !value.origin.fitted_to.empty())
          << name << " " << value.name;
      fitted += value.origin.confidence == "fitted";
    }
    EXPECT_LE(fitted, 2) << name;
  }
}

TEST(Machine, BuiltInFilesHoldThePublishedFigures) {
  const Machine ti = load("geforce4-ti4400");
  EXPECT_EQ(ti.name, "geforce4-ti4400");
  EXPECT_EQ(ti.numbers.vertex_arithmetic, Arithmetic::nv20);
  EXPECT_EQ(ti.vertex.units, 2);
  EXPECT_EQ(ti.vertex.cache_entries, 18);
  EXPECT_EQ(ti.clock.core_megahertz, 275);
  for (const auto name : built_in_names()) {
    const Machine machine = load(name);
    EXPECT_EQ(machine.memory.channels * machine.memory.channel_bytes_per_clock, 32) << name;  // 8.8 GB/s
  }
}

TEST(Machine, DefaultsLieInTheirRanges) {
  for (const auto& value : describe(Machine{})) {
    Machine machine;
    EXPECT_NO_THROW(set(machine, value.name + "=" + value.value)) << value.name;
  }
}

TEST(Machine, EveryNameIsDeclaredOnce) {
  std::map<std::string_view, int> seen;
  for (const auto& parameter : parameters()) EXPECT_EQ(++seen[parameter.name], 1) << parameter.name;
}

TEST(Machine, ErrorsNameTheLineAndWhatWasExpected) {
  EXPECT_EQ(message_of("\n[vertex]\nunits = 99\n"),
            "m.toml:3: vertex.units is out of range (99), expected an integer, 1 to 16");
  EXPECT_EQ(message_of("[vertex]\nunits = { value = 2.5 }\n"),
            "m.toml:2: vertex.units has the wrong type, expected an integer, 1 to 16");
  EXPECT_EQ(
      message_of("[agp]\nlanes = 2\n"),
      "m.toml:2: unknown key \"agp.lanes\", expected one of bytes_per_clock, latency_nanoseconds, queue");
  EXPECT_EQ(message_of("[numbers]\n\nframe = \"rgb\"\n"),
            "m.toml:3: numbers.frame is \"rgb\", expected a string, unorm8 or float32 or unorm10 or "
            "unorm16 or half");
  EXPECT_EQ(message_of("[vertex]\nunits = { value = 2, confidence = \"sure\" }\n"),
            "m.toml:2: confidence of vertex.units is \"sure\", expected published, measured, inferred, "
            "fitted, stand-in");
  EXPECT_EQ(message_of("[vertex]\nunits = { confidence = \"fitted\" }\n"),
            "m.toml:2: vertex.units has no value, expected { value = ..., confidence = ..., source = ... }");
  EXPECT_EQ(message_of("title = \"a\"\n[memory]\nchannels = 3\n"),
            "m.toml:3: memory.channels is 3, expected an integer, 1 to 16, a power of two");
  EXPECT_EQ(message_of("base = \"geforce4-ti4400\"\n[texture]\nfill_bytes = 32\n"),
            "m.toml:3: texture.fill_bytes is 32, expected at most texture.line_bytes (16)");
  EXPECT_EQ(message_of("vertex = 2\n"), "m.toml:1: vertex is a value, expected a table [vertex]");
  EXPECT_TRUE(message_of("[shader]\nunits = 2\n")
                  .starts_with("m.toml:1: unknown key \"shader\", expected title, base or"));
  EXPECT_TRUE(message_of("title = \"a\"\n[vertex\n").starts_with("m.toml:2: "));
  EXPECT_EQ(message_of("base = \"radeon-8500\"\ntitle = \"\\u001b[2J\"\n"),
            "m.toml:2: title has control characters, expected text on one line");
  EXPECT_EQ(message_of("base = \"radeon-8500\"\ntitle = \"\\u009b2J\"\n"),
            "m.toml:2: title has control characters, expected text on one line");
  EXPECT_EQ(message_of("base = \"radeon-8500\"\ntitle = \"\\u00e9\"\n"), "no error");
  EXPECT_EQ(message_of("base = \"radeon-8500\"\n[vertex]\nunits = { value = 2, source = \"\\u001b[31m\" }\n"),
            "m.toml:3: source of vertex.units has control characters, expected text on one line");
  EXPECT_EQ(message_of("base = \"voodoo\"\n"),
            "m.toml:1: no machine \"voodoo\", expected geforce4-ti4400 or radeon-8500");
}

// Such a file would be a machine of defaults.
TEST(Machine, AFileWithoutABaseIsAMachineOfItsOwn) {
  const std::string expected =
      ", expected base = \"geforce4-ti4400\" or \"radeon-8500\", or a title and parameters of its own";
  EXPECT_EQ(message_of(""), "m.toml: no base and no title" + expected);
  EXPECT_EQ(message_of("[vertex]\nunits = 3\n"), "m.toml: no base and no title" + expected);
  EXPECT_EQ(message_of("title = \"Mine\"\n"), "m.toml: no base and no parameters" + expected);
  EXPECT_EQ(parse("title = \"Mine\"\n[vertex]\nunits = 3\n", "m.toml").vertex.units, 3);
  EXPECT_EQ(parse("base = \"radeon-8500\"\n", "m.toml").title, "ATI Radeon 8500 (R200), changed by m");
  EXPECT_EQ(parse("base = \"radeon-8500\"\n", "m.toml").memory.channels, 2);
}

TEST(Machine, AValueWithoutASourceSaysSo) {
  const Machine machine = parse(
      "base = \"radeon-8500\"\n[vertex]\nunits = 3\nthreads = { value = 2 }\n"
      "vector_latency = { value = 5, source = \"a guess\" }\n"
      "scalar_latency = { value = 5, confidence = \"measured\" }\n",
      "dir/m.toml");
  const auto says = [&](std::string_view name) {
    const Machine::Origin& origin = machine.origins.find(name)->second;
    return origin.confidence + ": " + origin.source;
  };
  EXPECT_EQ(says("vertex.units"), "stand-in: dir/m.toml, without a source");
  EXPECT_EQ(says("vertex.threads"), "stand-in: dir/m.toml, without a source");
  EXPECT_EQ(says("vertex.vector_latency"), "stand-in: a guess");
  EXPECT_EQ(says("vertex.scalar_latency"), "measured: dir/m.toml, without a source");
}

TEST(Machine, AFileMayChangeABase) {
  const Machine machine = parse("base = \"radeon-8500\"\n[vertex]\nunits = 4\n", "dir/wide.toml");
  EXPECT_EQ(machine.name, "wide");
  EXPECT_EQ(machine.vertex.units, 4);
  EXPECT_EQ(machine.memory.channels, 2);
}

TEST(Machine, SetChangesOneParameter) {
  Machine machine = load("geforce4-ti4400");
  set(machine, "vertex.units=4");
  set(machine, "numbers.frame=float32");
  set(machine, "host.command_nanoseconds=5");
  set(machine, "depth.fast_clear=false");
  EXPECT_EQ(machine.vertex.units, 4);
  EXPECT_EQ(machine.numbers.frame, FrameFormat::float32);
  EXPECT_EQ(machine.host.command_nanoseconds, 5);
  EXPECT_FALSE(machine.depth.fast_clear);
  for (const auto& value : describe(machine)) {
    if (value.name == "vertex.units") {
      EXPECT_EQ(value.origin.confidence, "set");
    }
  }
}

TEST(Machine, SetRefusesWhatAFileMayNotHold) {
  EXPECT_EQ(set_message("vertex.units"),
            "--set: \"vertex.units\" has no value, expected key=value as in vertex.units=4");
  EXPECT_EQ(set_message("vertex.units=0"),
            "--set: vertex.units is out of range (0), expected an integer, 1 to 16");
  EXPECT_EQ(set_message("vertex.units=two"),
            "--set: vertex.units has no valid value in \"vertex.units=two\", expected an integer, 1 to 16");
  EXPECT_EQ(
      set_message("vertex.units=2 # two"),
      "--set: vertex.units has no valid value in \"vertex.units=2 # two\", expected an integer, 1 to 16");
  for (const char* text :
       {"numbers.frame=half\" #", "numbers.frame=\"half\" # a", "numbers.frame=h\\u0061lf"})
    EXPECT_TRUE(set_message(text).starts_with("--set: numbers.frame ")) << text << ": " << set_message(text);
  EXPECT_EQ(set_message("vertex.units=2\n[clock]\ncore_megahertz=1"),
            "--set: the value of vertex.units has more than one line, expected an integer, 1 to 16");
  EXPECT_EQ(set_message("agp.units=2"),
            "--set: unknown key \"agp.units\", expected one of bytes_per_clock, latency_nanoseconds, queue");
  EXPECT_TRUE(set_message("=3").starts_with("--set: unknown key \"\", expected a group of "));
  EXPECT_EQ(set_message("texture.line_bytes=128"),
            "--set: texture.line_bytes is 128, expected at most memory.interleave_bytes (64)");
}

TEST(Machine, WhatFitsTogetherMayBeAssignedInAnyOrder) {
  Machine machine = load("geforce4-ti4400");
  assign(machine, "memory.interleave_bytes=4096");
  EXPECT_EQ(error_of([&] { check(machine); }),
            "--set: memory.interleave_bytes is 4096, expected at most memory.row_bytes (1024)");
  assign(machine, "memory.row_bytes=4096", "--sweep");
  EXPECT_EQ(error_of([&] { check(machine); }), "no error");
  EXPECT_EQ(error_of([&] { assign(machine, "memory.row_bytes=3000", "--sweep"); }),
            "--sweep: memory.row_bytes is 3000, expected an integer, 256 to 65536, a power of two");
  // What the machine itself has may be what another parameter no longer leaves room for.
  machine = load("geforce4-ti4400");
  machine.memory.interleave_bytes = 1024;
  assign(machine, "memory.row_bytes=512");
  EXPECT_EQ(error_of([&] { check(machine); }),
            "--set: memory.interleave_bytes is 1024, expected at most memory.row_bytes (512)");
}

TEST(Machine, AMissingFileIsAUsersError) {
  EXPECT_THROW(load("no/such.toml"), UserError);
  EXPECT_THROW(load("voodoo"), UserError);
}

}  // namespace
}  // namespace splatscope::machine
