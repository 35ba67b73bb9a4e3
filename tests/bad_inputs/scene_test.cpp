#include <set>

#include "cases.h"
#include "traces/scene_keys.h"

namespace splatscope::tests {
namespace {

// What no key of the kind takes, as it stands in a file.
std::vector<std::string> bad_values(const traces::SceneKey& key) {
  using Values = std::vector<std::string>;
  return std::visit(
      traces::Overloaded{
          [](const traces::RealValue&) {
            return Values{"nan", "inf", "-inf", "1e300", "-1e300", "\"1\"", "true", "[1]", "1979-05-27"};
          },
          [](const traces::IntegerValue&) {
            return Values{"nan", "inf", "9223372036854775807", "99999999999999999999", "-1", "1.5", "{}"};
          },
          [](const traces::BooleanValue&) {
            return Values{"nan", "1", "\"true\"", "[]"};
          },
          [](const traces::TextValue&) {
            return Values{"nan", "5", "[\"a\"]"};
          },
          [](const traces::ChoiceValue&) {
            return Values{"nan", "0", "\"\"", "\"none such\""};
          },
          [](const traces::VectorValue&) {
            return Values{"nan",    "[nan, 0, 0]",  "[0, inf, 0]", "[0, 0, 1e300]",
                          "[0, 0]", "[0, 0, 0, 0]", "\"x\""};
          },
          [](const traces::PlacesValue&) {
            return Values{"nan", "\"x\"", "[nan, 1]", "[0, inf]", "[1, 0]", "[0, 0]", "[0, 1e300]"};
          },
          [](const traces::TransferValue&) {
            return Values{"nan",
                          "\"x\"",
                          "[0]",
                          "[{}]",
                          "[{ value = nan, opacity = 0, color = [0, 0, 0] }]",
                          "[{ value = 0, opacity = 2, color = [0, 0, 0] }]",
                          "[{ value = 0, opacity = 0, color = [0, 0] }]"};
          }},
      key.value);
}

const std::vector<std::string> kRecord = {"record", "bad.toml", "-o", "bad.trace"};

TEST(BadInputs, ScenesWithAWrongValue) {
  BadInputs inputs;
  for (const traces::SceneKey& key : traces::scene_keys()) {
    for (const std::string& value : bad_values(key)) {
      const std::string line = fmt::format("{} = {}\n", key.name, value);
      inputs.file("bad.toml", fmt::format("[{}]\n{}", key.table, line));
      inputs.refused(fmt::format("[{}] {}", key.table, line), kRecord);
    }
  }
  EXPECT_GE(inputs.count(), 200);
}

// All keys of some tables at their defaults, but those that `start` gives in the first of these tables.
std::string scene_of_defaults(const std::string& start, const std::set<std::string_view>& tables) {
  std::string text = start, table(start.substr(1, start.find(']') - 1));
  for (const traces::SceneKey& key : traces::scene_keys()) {
    if (!tables.contains(key.table)) continue;
    if (table != key.table) text += fmt::format("[{}]\n", key.table);
    table = key.table;
    if (start.find(fmt::format("\n{} = ", key.name)) == std::string::npos)
      text += fmt::format("{} = {}\n", key.name, traces::default_text(key));
  }
  return text;
}

// Small ones: the first bytes are beyond any cut.
TEST(BadInputs, ScenesCutShort) {
  BadInputs inputs;
  std::set<std::string_view> of_surfels;
  for (const traces::SceneKey& key : traces::scene_keys())
    if (key.table != "volume") of_surfels.insert(key.table);
  for (const auto& [start, tables] : std::vector<std::pair<std::string, std::set<std::string_view>>>{
           {"[surfels]\ncolumns = 4\nrows = 4\n", of_surfels},
           {"[frame]\nwidth = 16\nheight = 16\n", {"frame", "volume"}}}) {
    const std::string whole = scene_of_defaults(start, tables);
    inputs.file("bad.toml", whole);
    inputs.used(start, kRecord);
    for (std::size_t size = start.size(); size < whole.size(); size += 64) {
      inputs.file("bad.toml", whole.substr(0, size));
      inputs.refused_or_used(fmt::format("{} bytes", size), kRecord);
    }
  }
  EXPECT_GE(inputs.count(), 10);
}

struct Bad {
  const char* what;
  std::string text;
};

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(BadInputs, ScenesThatAreNone) {
  BadInputs inputs;
  const Bad bad[] = {
      {"binary", std::string("\x7f"
                             "ELF\x02\x01\x01\0\0\0\xff\xfe",
                             12)},
      {"zeros", std::string(4096, '\0')},
      {"no UTF-8", "[surfels]\nfile = \"\xff\xfe\"\n"},
      {"2 MiB of spaces", std::string(2 << 20, ' ')},
      {"an array in 100000 arrays", "[surfels]\nfile = " + std::string(100000, '[')},
      {"a table in 100000 tables", "[surfels]\nfile = " + repeated("{a=", 100000)},
      {"a key of 100000 parts", repeated("a.", 100000) + "a = 1\n"},
      {"a table of 100000 parts", "[" + repeated("a.", 100000) + "a]\n"},
      {"a table twice", "[frame]\nwidth = 8\n[frame]\nwidth = 9\n"},
      {"a key twice", "[frame]\nwidth = 8\nwidth = 9\n"},
      {"a value for a table", "frame = 3\n"},
      {"tables for a table", "[[frame]]\nwidth = 8\n"},
      {"an unknown table", "[lights]\n"},
      {"an unknown key", "[frame]\ndepth = 8\n"},
      {"a string without end", "[surfels]\nfile = \"x\n"},
      {"near beyond far", "[camera]\nnear = 5\nfar = 5\n"},
      {"no view", "[camera]\neye = [0, 0, 0]\ntarget = [0, 0, 0]\n"},
      {"up along the view", "[camera]\neye = [0, 0, 0]\ntarget = [0, 5, 0]\nup = [0, 1, 0]\n"},
      {"no up", "[camera]\nup = [0, 0, 0]\n"},
      {"a box inside out", "[capture]\nbox_min = [1, 0, 0]\nbox_max = [0, 1, 1]\n"},
      {"refine of the wrong algorithm", "[splatting]\nalgorithm = \"no-ewa\"\nrefine = true\n"},
      {"a missing file", "[surfels]\nfile = \"none.ply\"\n"},
      {"a folder as file", "[surfels]\nfile = \".\"\n"},
      {"itself as file", "[surfels]\nfile = \"bad.toml\"\n"},
      {"a device as file", "[surfels]\nfile = \"/dev/zero\"\n"},
      {"a name of 5000 bytes", "[surfels]\nfile = \"" + std::string(5000, 'x') + ".ply\"\n"},
      {"a name with a line's end", "[surfels]\nfile = \"a\\nb.ply\"\n"},
      {"a name with a zero", "[surfels]\nfile = \"a\\u0000b.ply\"\n"},
  };
  for (const Bad& b : bad) {
    inputs.file("bad.toml", b.text);
    inputs.refused(b.what, kRecord);
    inputs.refused(b.what, {"run", "bad.toml", "--fidelity", "functional"});
  }
}

}  // namespace
}  // namespace splatscope::tests
