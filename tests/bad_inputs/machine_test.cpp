#include "cases.h"
#include "model/machine/parameters.h"

namespace splatscope::tests {
namespace {

// What no parameter of any kind takes.
constexpr const char* kNoValues[] = {"nan",
                                     "inf",
                                     "-inf",
                                     "-1e300",
                                     "1e300",
                                     "9223372036854775807",
                                     "[1]",
                                     "1979-05-27",
                                     "\"none such\"",
                                     "99999999999999999999",
                                     "-1"};

std::string file_of(std::string_view parameter, std::string_view value) {
  const std::size_t dot = parameter.find('.');
  return fmt::format("[{}]\n{} = {}\n", parameter.substr(0, dot), parameter.substr(dot + 1), value);
}

TEST(BadInputs, MachinesWithAWrongValue) {
  BadInputs inputs;
  std::size_t turn = 0;  // each parameter meets a few of the values, and all values meet parameters
  for (const machine::Parameter& parameter : machine::parameters()) {
    for (int i = 0; i < 3; ++i) {
      const char* value = kNoValues[turn++ % std::size(kNoValues)];
      inputs.file("bad.toml", file_of(parameter.name, value));
      inputs.refused(fmt::format("{} = {}", parameter.name, value), {"machine", "show", "bad.toml"});
    }
  }
  EXPECT_GE(inputs.count(), 150);
}

TEST(BadInputs, SettingsWithAWrongValue) {
  BadInputs inputs;
  inputs.file("tiny.toml", kTinyScene);
  std::size_t turn = 0;
  for (const machine::Parameter& parameter : machine::parameters()) {
    const char* value = kNoValues[turn++ % std::size(kNoValues)];
    inputs.refused("a wrong value",
                   {"run", "tiny.toml", "--set", fmt::format("{}={}", parameter.name, value)});
  }
  for (const char* setting :
       {"", "=", "vertex.units", "vertex.units=", "=4", "vertex=4", "units=4", "vertex.units=4=4",
        "vertex.units=4\nvertex.units=5", "vertex.units = [", "vertex.units=\xff"}) {
    inputs.refused("no setting", {"run", "tiny.toml", "--set", setting});
    inputs.refused("no setting", {"sweep", "tiny.toml", "--sweep", setting});
  }
}

TEST(BadInputs, MachinesCutShort) {
  BadInputs inputs;
  const std::string whole = text_of(std::string(SPLATSCOPE_SOURCE) + "/model/machine/radeon-8500.toml");
  inputs.cut("bad.toml", whole, [&](const std::string& what) {
    inputs.refused_or_used(what, {"machine", "show", "bad.toml"});
  });
  EXPECT_GE(inputs.count(), 50);
}

TEST(BadInputs, MachinesThatAreNone) {
  BadInputs inputs;
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "a.";
  const std::pair<const char*, std::string> bad[] = {
      {"binary", std::string("\x7f"
                             "ELF\x02\x01\x01\0\0\0\xff\xfe",
                             12)},
      {"zeros", std::string(4096, '\0')},
      {"2 MiB of comment", "#" + std::string(2 << 20, 'x')},
      {"a key of 100000 parts", deep + "a = 1\n"},
      {"a value for a group", "vertex = 3\n"},
      {"an unknown group", "[shaders]\n"},
      {"an unknown key", "[vertex]\nunts = 3\n"},
      {"a base that there is not", "base = \"voodoo\"\n"},
      {"itself as base", "base = \"bad\"\n"},
      {"its path as base", "base = \"bad.toml\"\n"},
      {"a base that is a number", "base = 8\n"},
      {"a value of no value", "[vertex]\nunits = { source = \"x\" }\n"},
      {"an unknown word beside a value", "[vertex]\nunits = { value = 2, sauce = \"x\" }\n"},
      {"no power of two", "[memory]\nbanks = 3\n"},
      {"more ways than lines", "[texture]\ncache_lines = 4\ncache_ways = 8\n"},
  };
  for (const auto& [what, text] : bad) {
    inputs.file("bad.toml", text);
    inputs.refused(what, {"machine", "show", "./bad.toml"});
    inputs.file("tiny.toml", kTinyScene);
    inputs.refused(what, {"run", "tiny.toml", "--machine", "bad.toml"});
  }
}

}  // namespace
}  // namespace splatscope::tests
