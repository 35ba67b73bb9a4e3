#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "model/number/formats.h"

// A machine: every figure that its function (number formats) and its timing depend on. What each member is,
// its unit and its range stand in the table of parameters.cpp, once. A timing unit takes its group of
// parameters as its specification: sim/units/vertex is built from `Vertex`.
namespace splatscope {

struct Machine {
  struct Clock {
    double core_megahertz = 275;
    double bus_megahertz = 200.0 / 3;
  };
  struct Vertex {
    int units = 2;
    int threads = 1;
    int vector_latency = 1;
    int scalar_latency = 1;
    int scalar_interval = 1;
    bool pairing = false;
    bool driver_reorders = false;
    int reload_cycles = 0;
    int cache_entries = 18;
    int output_vertices = 4;
  };
  struct Fetch {
    int line_bytes = 64;
    int cache_lines = 16;
    int cache_ways = 4;
    int pending_vertices = 16;
    int index_lines = 4;
    int indices_per_clock = 1;
  };
  struct Primitive {
    int clocks_per_triangle = 1;
    int clip_clocks = 4;
    int queue = 8;
  };
  struct Setup {
    int clocks_per_triangle = 2;
    int latency = 10;
    int queue = 8;
  };
  struct Raster {
    int tiles_per_clock = 1;
    int latency = 4;
    int queue = 8;
  };
  struct Depth {
    int cache_lines = 32;
    int cache_ways = 4;
    int pending = 64;
    int latency = 4;
    int queue = 8;
    bool fast_clear = true;
  };
  struct Texture {
    int cache_lines = 256;
    int cache_ways = 4;
    int line_bytes = 16;
    int fill_bytes = 16;
    int lookups_per_clock = 4;
    int pending = 128;
    int latency = 8;
    int queue = 8;
  };
  struct Pixel {
    int quads_per_clock = 1;
    int instructions_per_clock = 2;
    int latency = 12;
    int queue = 8;
  };
  struct Blend {
    int cache_lines = 32;
    int cache_ways = 4;
    int pending = 64;
  };
  struct Memory {
    int channels = 4;
    int channel_bytes_per_clock = 8;
    int burst_bytes = 16;
    int interleave_bytes = 64;
    int banks = 4;
    int row_bytes = 1024;
    int precharge_clocks = 5;
    int activate_clocks = 5;
    int cas_clocks = 4;
    int row_active_clocks = 12;
    int write_recovery_clocks = 3;
    int turnaround_clocks = 2;
    int request_queue = 8;
    int schedule_queue = 16;
    int bypass_limit = 16;
    int return_latency = 20;
  };
  struct Agp {
    int bytes_per_clock = 16;
    double latency_nanoseconds = 300;
    int queue = 16;
  };
  struct Host {
    double command_nanoseconds = 1000;
    double uncached_read_nanoseconds = 900;
    int uncached_read_bytes = 1;
    double division_nanoseconds = 40;
    int write_bytes_per_clock = 4;
  };

  std::string name;   // "geforce4-ti4400", or the file
  std::string title;  // "NVIDIA GeForce4 Ti 4400 (NV25)"
  NumberFormats numbers;
  Clock clock;
  Vertex vertex;
  Fetch fetch;
  Primitive primitive;
  Setup setup;
  Raster raster;
  Depth depth;
  Texture texture;
  Pixel pixel;
  Blend blend;
  Memory memory;
  Agp agp;
  Host host;

  // Where a value came from; `confidence` is published, measured, inferred, fitted or stand-in ("default": no
  // file gave it; "set": the command line did). `fitted_to` names the published rows, as in "table1
  // ewa-per-pixel".
  struct Origin {
    std::string confidence = "default";
    std::string source;
    std::string fitted_to;
    int line = 0;  // of the machine's own file that gave the value; 0: its base or an option did
  };
  std::map<std::string, Origin, std::less<>> origins;  // by parameter name; absent: default
};

namespace machine {

// The machines that are part of the program, by name; the first is taken where none is named.
inline constexpr std::string_view kGeForce4 = "geforce4-ti4400", kRadeon8500 = "radeon-8500";
std::vector<std::string_view> built_in_names();

// A built-in machine by name, or a TOML file by path (a name with a '.' or a '/').
// UserError with file and line where it cannot be read, or a key, a type or a value is wrong.
Machine load(std::string_view name_or_path);

// The same from text; `file` is for messages and becomes the machine's name without folder and ".toml".
Machine parse(std::string_view text, std::string_view file);

// One parameter: "vertex.units=4". UserError (file `option`) where key, type or value is wrong. What must fit
// together is left to check(): then the order of several does not matter.
void assign(Machine& machine, std::string_view assignment, std::string_view option = "--set");

// That the parameters fit together. UserError (file: the option that gave the value, else the machine).
void check(const Machine& machine);

// Both, where there is one assignment.
void set(Machine& machine, std::string_view assignment, std::string_view option = "--set");

// A parameter as `machine show` prints it.
struct ParameterValue {
  std::string name;   // "vertex.units"
  std::string value;  // as TOML
  std::string unit;   // "clocks"; empty: a plain number or a choice
  std::string range;  // "1 to 16", "true or false", "unorm8 or float32"
  std::string what;
  Machine::Origin origin;
};
std::vector<ParameterValue> describe(const Machine& machine);

// The value of one of them, as TOML. UserError where there is none of this name.
std::string value_of(const Machine& machine, std::string_view name);

}  // namespace machine
}  // namespace splatscope
