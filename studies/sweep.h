#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/run.h"

// One frame, its function once, its timing on many machines.
namespace splatscope::studies {

// "vertex.units=1,2,4": a parameter and the values that it takes. Throws UserError (file "--sweep").
struct SweptParameter {
  std::string key;
  std::vector<std::string> values;
};
SweptParameter swept_parameter(std::string_view text);
// Of a command line, where `settings` ("vertex.units=2") hold for all machines. Throws UserError also where a
// key is swept twice, or swept and set: the last would hold, and the results say another.
std::vector<SweptParameter> swept_parameters(const std::vector<std::string>& texts,
                                             const std::vector<std::string>& settings);

// One machine of the sweep.
struct SweepPoint {
  std::vector<std::pair<std::string, std::string>> settings;  // by parameter, as the machine holds them
  nlohmann::ordered_json results;  // as `frames`, `units` and `units_left_out` of a run's results
  Rate rate;                       // of all frames
  std::uint64_t cycles = 0;        // the same, and half the width of its 95 % interval (`sampled`; else 0)
  double cycles_plus_minus = 0;
};

struct Sweep {
  Input input;
  std::vector<SweepPoint> points;
  std::size_t functions = 0;                   // computed: one for each set of number formats
  std::size_t from_cache = 0;                  // read from the cache instead
  std::vector<std::filesystem::path> damaged;  // of the cache: computed again
  std::vector<std::string> not_kept;           // why work that was computed is not in the cache
  std::vector<std::string> replaced;           // programs, a line for people on each
  std::optional<std::uint64_t> seed;           // of the samples of `sampled`
  double host_seconds = 0;
};

struct SweepOptions {
  std::vector<std::string> programs = {};               // NAME=FILE, as replace_programs takes them
  std::optional<std::filesystem::path> cache = {};      // a folder for WorkCache
  std::uint64_t seed = 1;                               // of the samples of `sampled`
  std::function<void(const Opened&)> before_work = {};  // called once the input is found right, with that
};

// Every combination of the values, the last parameter running fastest, on `machine`, whose own parameters
// need fit together only with those values. Parameters that the function depends on (numbers.*,
// vertex.cache_entries) may be swept too: it is then computed for each. Timings run in as many processes as
// the host has threads. Throws UserError where the input, a machine or a program is wrong, or a value is
// there twice, before any of it is run.
Sweep run_sweep(const std::string& scene_or_trace, const Machine& machine,
                const std::vector<SweptParameter>& parameters, Fidelity fidelity,
                const SweepOptions& options = {}, const Progress& progress = {});

nlohmann::ordered_json results_of(const Sweep& sweep, const Machine& machine, Fidelity fidelity);

}  // namespace splatscope::studies
