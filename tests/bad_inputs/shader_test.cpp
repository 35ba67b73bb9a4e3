#include "cases.h"

namespace splatscope::tests {
namespace {

std::string kernel(const std::string& name) {
  return text_of(std::string(SPLATSCOPE_SOURCE) + "/kernels/object_space_ewa/" + name);
}

TEST(BadInputs, ShadersCutShort) {
  BadInputs inputs;
  inputs.cut("cut.vs", kernel("visibility.vs"), [&](const std::string& what) {
    inputs.refused_or_used(what, {"shader", "check", "cut.vs"});
  });
  inputs.file("whole.vs", kernel("splat_ewa.vs"));
  Forked({"shader", "assemble", "whole.vs", "-o", "whole.bin"}, inputs.path()).outcome();
  const std::string tokens = text_of(inputs.path() / "whole.bin");
  ASSERT_GT(tokens.size(), 500u);
  inputs.cut("cut.bin", tokens, [&](const std::string& what) {
    inputs.refused(what, {"shader", "disassemble", "cut.bin"});
  });
  EXPECT_GE(inputs.count(), 20);
}

std::string instructions(int count) {
  std::string text = "vs_1_1\n";
  for (int i = 0; i < count; ++i) text += "mov oPos, v0\n";
  return text;
}

TEST(BadInputs, ShadersThatBreakARule) {
  BadInputs inputs;
  const std::pair<const char*, std::string> bad[] = {
      {"empty", ""},
      {"zeros", std::string(4096, '\0')},
      {"binary", std::string("\x7f"
                             "ELF\x02\x01\x01\0\0\0\xff\xfe",
                             12)},
      {"2 MiB of comment", fmt::format(";{}", std::string(2 << 20, 'x'))},
      {"a word of 100000 bytes", "vs_1_1\n" + std::string(100000, 'm')},
      {"a line of 100000 commas", "vs_1_1\nmov oPos" + std::string(100000, ',')},
      {"a later version", "vs_2_0\nmov oPos, v0\n"},
      {"no version", "mov oPos, v0\n"},
      {"129 instructions", instructions(129)},
      {"100000 instructions", instructions(100000)},
      {"a register v16", "vs_1_1\nmov oPos, v16\n"},
      {"a register r4000000000", "vs_1_1\nmov oPos, r4000000000\n"},
      {"a register c-1", "vs_1_1\nmov oPos, c-1\n"},
      {"a constant NaN", "vs_1_1\ndef c0, nan, 0, 0, 0\nmov oPos, c0\nmov r9, r9.foo\n"},
      {"a constant of 1e999", "vs_1_1\ndef c0, 1e999, 0, 0\n"},
      {"an unknown instruction", "vs_1_1\ntexld r0, t0\n"},
      {"an unwritten register", "vs_1_1\nmov oPos, r0\n"},
      {"no output", "vs_1_1\nmov r0, v0\n"},
      {"two versions", "vs_1_1\nps_1_1\n"},
      {"tokens without end", std::string("\x01\x01\xfe\xff", 4)},
      {"tokens of a later version", std::string("\x00\x03\xfe\xff\xff\xff\x00\x00", 8)},
      {"tokens of all ones", std::string("\x01\x01\xfe\xff", 4) + std::string(400, '\xff')},
      {"tokens of an odd number of bytes", std::string("\x01\x01\xfe\xff\xff\xff\x00", 7)},
  };
  for (const auto& [what, text] : bad) {
    inputs.file("bad.vs", text);
    inputs.refused(what, {"shader", "check", "bad.vs"});
    inputs.refused(what, {"shader", "assemble", "bad.vs", "-o", "out.bin"});
  }
}

// A line that is no case is told of at the end; the others have their answers.
TEST(BadInputs, BatchesAndRegistersThatAreNone) {
  BadInputs inputs;
  inputs.file("good.vs", kernel("splat_plain.vs"));
  const std::pair<const char*, std::string> bad[] = {
      {"no registers", "[]"},
      {"cut", "{\"constants\": {\"c0\": [\"3f8"},
      {"zeros", std::string(64, '\0')},
      {"an array in arrays", std::string(100000, '[')},
      {"an object in objects",
       [] {
         std::string deep;
         for (int i = 0; i < 100000; ++i) deep += "{\"a\":";
         return deep;
       }()},
      {"an unknown register", "{\"constants\": {\"c96\": [\"0\", \"0\", \"0\", \"0\"]}}"},
      {"three components", "{\"constants\": {\"c0\": [\"0\", \"0\", \"0\"]}}"},
      {"no hexadecimal", "{\"constants\": {\"c0\": [\"x\", \"0\", \"0\", \"0\"]}}"},
      {"nine digits", "{\"constants\": {\"c0\": [\"123456789\", \"0\", \"0\", \"0\"]}}"},
  };
  for (const auto& [what, text] : bad) {
    inputs.file("bad.json", text);
    inputs.refused(what, {"shader", "debug", "good.vs", "--registers", "bad.json"});
  }
  for (const char* line : {"nonsense", "[]", "3", "{", "\xff\xfe"}) {
    inputs.file("bad.jsonl", line);
    inputs.refused_with_output(line, {"shader", "run", "--batch", "bad.jsonl"});
  }
}

}  // namespace
}  // namespace splatscope::tests
