#include "command_line.h"

namespace splatscope::tests {
namespace {

// Words that any option may be given by mistake: refused by a message that begins with the word.
class Arguments : public testing::Test {
 protected:
  Arguments() {
    folder_.file("a.vs", "vs_1_1\nmov oPos, v0\n");
    folder_.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder_.file("s.toml", "[surfels]\ncolumns = 2\nrows = 2\n[frame]\nwidth = 8\nheight = 8\n");
    folder_.file("v.toml", "[volume]\nvoxels = [4, 4, 4]\n[frame]\nwidth = 8\nheight = 8\n");
  }

  void expect_refused(const std::vector<std::string>& arguments, const std::string& error) const {
    const std::string said = tests::expect_refused(folder_, arguments, error);
    EXPECT_TRUE(said.starts_with(error)) << said;
  }

  const ScratchFolder folder_;
};

// Every option that names an output, without its value.
const std::vector<std::vector<std::string>> kOutputs = {
    {"shader", "assemble", "a.vs", "-o"},
    {"shader", "disassemble", "a.vs", "-o"},
    {"record", "s.toml", "-o"},
    {"sample", "m.obj", "-n", "5", "-o"},
    {"run", "s.toml", "--out"},
    {"run", "s.toml", "--out", "o", "--counters"},
    {"run", "s.toml", "--out", "o", "--timeline"},
    {"run", "s.toml", "--out", "o", "--pipeline"},
    {"sweep", "s.toml", "--sweep", "vertex.units=1", "--out"},
    {"sweep", "s.toml", "--sweep", "vertex.units=1", "--out", "o", "--cache"},
    {"volume", "v.toml", "--out"},
    {"reproduce", "fig3", "--out"},
    {"study", "vertex-data", "--out"}};

TEST_F(Arguments, ADashIsNoOutput) {
  for (std::vector<std::string> arguments : kOutputs) {
    arguments.emplace_back("-");
    expect_refused(arguments, "-: is not standard output here, expected a file's or folder's name");
  }
  EXPECT_EQ(run_program({"shader", "assemble", "a.vs", "-o", "./-"}, folder_.path()).status, 0);
}

TEST_F(Arguments, NoneIsEmpty) {
  for (std::vector<std::string> arguments : kOutputs) {
    const std::string option =
        arguments.back() == "-o" && arguments[0] == "shader" ? "--out" : arguments.back();
    arguments.emplace_back();
    expect_refused(arguments, "splatscope: " + option + ": \"\" is empty, expected a name or a value");
  }
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& option) {
    expect_refused(arguments, "splatscope: " + option + ": \"\" is empty, expected a name or a value");
  };
  refused({"run", "", "--out", "o"}, "INPUT");
  refused({"sample", "", "-o", "s.ply"}, "MESH");
  refused({"run", "s.toml", "--machine", "", "--out", "o"}, "--machine");
  refused({"explain", "s.toml", "--pixel", ""}, "--pixel");
  refused({"shader", "debug", "a.vs", "--registers", ""}, "--registers");
  refused({"machine", "show", ""}, "NAME");
  refused({"study", ""}, "NAME");
  for (const char* option : {"--reference", "--reference="})
    expect_refused({"run", "s.toml", "--out", "o", option, ""},
                   "--reference: unknown map \"\", expected affine or perspective");
  expect_refused({"run", "s.toml", "--program", "splat_ewa.vs=", "--out", "o"},
                 "--program: \"splat_ewa.vs=\", expected NAME=FILE");
}

TEST_F(Arguments, WhatNothingTakesIsNamedInItsOrder) {
  expect_refused({"run", "s.toml", "b.toml", "c.toml", "--out", "o"},
                 "splatscope: not expected: b.toml c.toml (--help says what is expected)");
  expect_refused({"run", "s.toml", "--out", "o", "--set", "vertex.units", "=", "4"},
                 "splatscope: not expected: = 4 (a key and its value are one word: KEY=VALUE)");
}

TEST_F(Arguments, AParameterIsSetOnce) {
  const std::vector<std::string> twice{"--set", "vertex.units=1", "--set", "memory.channels=2",
                                       "--set", "vertex.units=2"};
  for (std::vector<std::string> arguments : {std::vector<std::string>{"run", "s.toml", "--out", "o"},
                                             {"sweep", "s.toml", "--out", "o", "--sweep", "setup.queue=1"}}) {
    arguments.insert(arguments.end(), twice.begin(), twice.end());
    expect_refused(arguments, "--set: vertex.units is given twice, expected one value");
  }
}

// As without the equals sign.
TEST_F(Arguments, AReferenceIsAffineWhereNothingFollowsIt) {
  for (const char* option : {"--reference", "--reference="}) {
    const Outcome outcome = run_program({"run", "s.toml", "--out", "o", option}, folder_.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_NE(outcome.out.find("against the reference: PSNR"), std::string::npos) << outcome.out;
  }
}

TEST_F(Arguments, RangesCanBeRead) {
  for (const char* every : {"0", "-5", "1e6", "1000000000001"})
    expect_refused({"run", "s.toml", "--out", "o", "--counters", "c.csv", "--counters-every", every},
                   std::string("splatscope: --counters-every: Value ") + every +
                       " not in range 1 to 1000000000000 (--help says");
  const Outcome most =
      run_program({"run", "s.toml", "--out", "o", "--counters", "c.csv", "--counters-every", "1000000000000"},
                  folder_.path());
  EXPECT_EQ(most.status, 0) << most.error;
}

}  // namespace
}  // namespace splatscope::tests
