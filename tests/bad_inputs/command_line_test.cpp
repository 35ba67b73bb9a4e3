#include "cases.h"

namespace splatscope::tests {
namespace {

TEST(BadInputs, CommandLines) {
  BadInputs inputs;
  inputs.file("tiny.toml", kTinyScene);
  inputs.file("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string long_word(100000, 'x');
  const std::vector<std::vector<std::string>> bad = {
      {},
      {""},
      {"runn"},
      {long_word},
      {"\xff\xfe"},
      {"--quiet"},
      {"run"},
      {"run", ""},
      {"run", "tiny.toml", "tiny.toml"},
      {"run", "tiny.toml", "--none"},
      {"run", "tiny.toml", "--out"},
      {"run", "tiny.toml", "--out", ""},
      {"run", "tiny.toml", "--fidelity", ""},
      {"run", "tiny.toml", "--fidelity", "nan"},
      {"run", "tiny.toml", "--machine", ""},
      {"run", "tiny.toml", "--machine", "."},
      {"run", "tiny.toml", "--machine", ".."},
      {"run", "tiny.toml", "--seed", "-1"},
      {"run", "tiny.toml", "--seed", "nan"},
      {"run", "tiny.toml", "--seed", "99999999999999999999999"},
      {"run", "tiny.toml", "--reference", "exact"},
      {"run", "tiny.toml", "--timeline-window", "5:9"},
      {"run", "tiny.toml", "--pipeline-window", "5:9"},
      {"run", "tiny.toml", "--counters-every", "10"},
      {"run", "tiny.toml", "--timeline", "t.json", "--timeline-window", "5"},
      {"run", "tiny.toml", "--timeline", "t.json", "--timeline-window", "5:4"},
      {"run", "tiny.toml", "--timeline", "t.json", "--timeline-window", "-1:4"},
      {"run", "tiny.toml", "--timeline", "t.json", "--timeline-window", "nan:inf"},
      {"run", "tiny.toml", "--timeline", "t.json", "--fidelity", "throughput"},
      {"run", "tiny.toml", "--timeline", "."},
      {"run", "tiny.toml", "--timeline", "none/t.json"},
      {"run", "tiny.toml", "--counters", "c.csv", "--counters-every", "0"},
      {"run", "tiny.toml", "--counters", "c.csv", "--counters-every", "-5"},
      {"run", "tiny.toml", "--counters", "c.csv", "--counters-every", "1e99"},
      {"run", "tiny.toml", "--counters", "/dev/full"},
      {"run", "tiny.toml", "--pipeline", "."},
      {"run", "tiny.toml", "--pipeline", "none/p.log"},
      {"run", "tiny.toml", "--pipeline", "p.log", "--fidelity", "sampled"},
      {"run", "tiny.toml", "--pipeline", "p.log", "--pipeline-window", "nan"},
      {"run", "tiny.toml", "--out", "new/folder", "--program", ""},
      {"run", "tiny.toml", "--out", "new/folder", "--program", "splat_ewa.vs"},
      {"run", "tiny.toml", "--out", "new/folder", "--program", "none.vs=tiny.toml"},
      {"run", "tiny.toml", "--out", "new/folder", "--program", "splat_ewa.vs=tiny.toml"},
      {"run", "tiny.toml", "--out", "new/folder", "--program", "splat_ewa.vs=none.vs"},
      {"run", "tiny.toml", "--out", "new/folder", "--program", "splat_ewa.vs=."},
      {"run", "tiny.toml", "--out", "new/folder", "--program", "splat_ewa.vs=/dev/zero"},
      {"sweep", "tiny.toml"},
      {"sweep", "tiny.toml", "--sweep", "vertex.units=1,2", "--fidelity", "functional"},
      {"sweep", "tiny.toml", "--sweep", "vertex.units=,"},
      {"sweep", "tiny.toml", "--sweep", "vertex.units=1,2,"},
      {"sweep", "tiny.toml", "--sweep", "vertex.units=1,nan"},
      {"sweep", "tiny.toml", "--sweep", "vertex.units=1,2", "--sweep", "vertex.units=3"},
      {"sweep", "tiny.toml", "--sweep", "vertex.units=1,2", "--set", "vertex.units=3"},
      {"sweep", "tiny.toml", "--sweep", "vertex.units=1,2", "--cache", "tiny.toml"},
      {"record", "tiny.toml"},
      {"record", "tiny.toml", "-o", ""},
      {"record", "tiny.toml", "-o", "."},
      {"record", "tiny.toml", "-o", "tiny.toml/x.trace"},
      {"record", "tiny.toml", "-o", long_word},
      {"record", "tiny.toml", "-o", "/dev/null"},
      {"record", "tiny.toml", "-o", "x.trace", "--machine", "voodoo"},
      {"sample", "tiny.toml", "-o", "s.ply"},
      {"sample", "", "-o", "s.ply"},
      {"sample", "mesh.obj", "-o", "s.ply", "-n", "0"},
      {"sample", "mesh.obj", "-o", "s.ply", "-n", "16777217"},
      {"sample", "mesh.obj", "-o", "s.ply", "-n", "nan"},
      {"sample", "mesh.obj", "-o", "s.ply", "--shading", "nan"},
      {"sample", "mesh.obj", "-o", "s.ply", "--shading", "2"},
      {"sample", "mesh.obj", "-o", "s.ply", "--pattern-scale", "nan"},
      {"sample", "mesh.obj", "-o", "s.ply", "--pattern-scale", "inf"},
      {"sample", "mesh.obj", "-o", "s.ply", "--pattern-scale", "0"},
      {"sample", "mesh.obj", "-o", "s.ply", "--pattern-scale", "0.1"},
      {"sample", "mesh.obj", "-o", "s.ply", "--pattern-scale", "0.1", "--pattern", "plain"},
      {"explain", "tiny.toml"},
      {"explain", "tiny.toml", "--pixel", "1"},
      {"explain", "tiny.toml", "--pixel", "-1,1"},
      {"explain", "tiny.toml", "--pixel", "48,1"},
      {"explain", "tiny.toml", "--pixel", "4294967297,1"},
      {"explain", "tiny.toml", "--pixel", "1,nan"},
      {"explain", "tiny.toml", "--vertex", "99,0"},
      {"explain", "tiny.toml", "--vertex", "0,99999999999"},
      {"explain", "tiny.toml", "--vertex", "1,-1"},
      {"machine", "show", ""},
      {"machine", "show", "voodoo"},
      {"machine", "show", "/dev/zero"},
      {"shader", "check", "/dev/zero"},
      {"shader", "run", "--batch", "none.jsonl"},
      {"shader", "run", "--batch", "."},
      {"shader", "run", "--batch", "none.jsonl", "--arithmetic", "exact"},
      {"trace", "info", "/dev/zero"},
      {"trace", "info", ""},
      {"study"},
      {"study", "none"},
      {"study", "vertex-data", "--list"},
      {"reproduce", "table9"},
      {"reproduce", ""},
  };
  for (const auto& arguments : bad) inputs.refused("", arguments);
}

// Taken down, the tables of so many parts would overflow the stack.
TEST(BadInputs, KeysOfTooManyParts) {
  BadInputs inputs;
  for (const char* first : {"a", "\"a\"", "\"\\\"\"", "'\\'", "\"\\\\\""}) {
    std::string key = first;
    for (int i = 0; i < 60000; ++i) key += ".a";
    inputs.file("deep.toml", key + " = 1\n");
    inputs.refused(first, {"machine", "show", "deep.toml"});
    inputs.refused(first, {"run", "deep.toml"});
  }
}

// Every kind of input against what is no file of that kind.
TEST(BadInputs, FilesThatAreNone) {
  BadInputs inputs;
  inputs.file("tiny.toml", kTinyScene);
  std::filesystem::create_directory(inputs.path() / "folder");
  std::filesystem::create_symlink("loop", inputs.path() / "loop");
  std::filesystem::create_symlink("none", inputs.path() / "dangling");
  std::filesystem::create_symlink("/dev/zero", inputs.path() / "endless");
  const std::string garbage = "\x89PNG\r\n\x1a\n" + std::string(1000, '\x9c');
  const std::string parts[] = {"none",     "folder",  "loop/x",  "loop",
                               "dangling", "endless", "garbage", std::string(300, 'x')};
  for (const char* ending : {".trace", ".toml", ".ply", ".obj", ".vs"}) {
    for (const std::string& name : parts) {
      const std::string file = name + ending;
      std::error_code error;
      std::filesystem::remove(inputs.path() / file, error);
      if (name == "garbage") inputs.file(file, garbage);
      if (std::filesystem::is_symlink(inputs.path() / name, error) || name == "folder")
        std::filesystem::create_symlink(name, inputs.path() / file, error);
      const std::string kind = ending;
      inputs.refused(file, {"run", file, "--fidelity", "functional"});
      if (kind == ".trace") inputs.refused(file, {"trace", "info", file});
      if (kind == ".toml") inputs.refused(file, {"machine", "show", file});
      if (kind == ".vs") inputs.refused(file, {"shader", "check", file});
      if (kind == ".obj" || kind == ".ply") inputs.refused(file, {"sample", file, "-o", "s.ply", "-n", "9"});
      if (kind == ".ply") {
        inputs.file("s.toml", fmt::format("[surfels]\nfile = \"{}\"\n", file));
        inputs.refused(file, {"record", "s.toml", "-o", "s.trace"});
      }
    }
  }
}

}  // namespace
}  // namespace splatscope::tests
