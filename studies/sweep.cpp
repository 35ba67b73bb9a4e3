#include "studies/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "model/error.h"
#include "model/machine/machine.h"
#include "model/processes.h"
#include "model/stop.h"
#include "studies/json_text.h"
#include "studies/measure.h"
#include "studies/own_program.h"
#include "studies/run_results.h"
#include "studies/work_cache.h"

namespace splatscope::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPoints = 100000;

// Machines of a sweep that have their function in common.
struct Group {
  Machine machine;  // one of them
  std::vector<std::size_t> points;
};

// With values as the machine holds them: +1 and 0x1 are 1. Each is checked, and that none is there twice.
std::vector<SweptParameter> as_held(const Machine& machine, std::vector<SweptParameter> parameters) {
  for (auto& [key, values] : parameters) {
    std::set<std::string> held;
    Machine changed = machine;
    for (std::string& value : values) {
      stop_if_asked();
      machine::assign(changed, key + "=" + value, "--sweep");
      const std::string given = std::exchange(value, unquoted(machine::value_of(changed, key)));
      if (!held.insert(value).second)
        throw UserError("--sweep", 0,
                        fmt::format("{} has {}{} twice, expected each value once", key, value,
                                    given == value ? "" : ", given as " + given + ","));
    }
  }
  return parameters;
}

std::vector<SweepPoint> combine(const std::vector<SweptParameter>& parameters) {
  std::vector<SweepPoint> points(1);
  for (const SweptParameter& parameter : parameters) {
    std::vector<SweepPoint> longer;
    for (const SweepPoint& point : points) {
      for (const std::string& value : parameter.values) {
        longer.push_back(point);
        longer.back().settings.emplace_back(parameter.key, value);
      }
    }
    points = std::move(longer);
  }
  return points;
}

Machine machine_of(const Machine& machine, const SweepPoint& point) {
  Machine changed = machine;
  for (const auto& [key, value] : point.settings) machine::assign(changed, key + "=" + value, "--sweep");
  machine::check(changed);
  return changed;
}

// Of machines whose frames are the same, bit for bit. That values fit together is checked on the way.
std::vector<Group> group(const Machine& machine, const std::vector<SweepPoint>& points) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Machine changed = machine_of(machine, points[i]);
    const auto same = std::ranges::find_if(
        groups, [&](const Group& g) { return render_options(g.machine) == render_options(changed); });
    if (same != groups.end()) {
      same->points.push_back(i);
    } else {
      groups.push_back({changed, {i}});
    }
  }
  return groups;
}

WorkStream compute(const Trace& trace, const RenderOptions& options) {
  Rendered rendered = render(trace, options);
  return {std::move(rendered.work), rendered.counters};
}

// From the cache where there is one that holds it.
WorkStream work_of(const Trace& trace, const Machine& machine, const std::optional<WorkCache>& cache,
                   Sweep& sweep) {
  const RenderOptions options = render_options(machine);
  if (!cache) {
    ++sweep.functions;
    return compute(trace, options);
  }
  const std::string key = work_key(trace, options);
  WorkStream stream;
  const WorkCache::Found found = cache->read(key, trace, stream);
  if (found == WorkCache::Found::yes) {
    ++sweep.from_cache;
    return stream;
  }
  if (found == WorkCache::Found::damaged) sweep.damaged.push_back(cache->path_of(key));
  ++sweep.functions;
  stream = compute(trace, options);
  try {
    cache->write(key, stream);
  } catch (const std::runtime_error& error) {  // a full disk, or a folder for reading alone
    sweep.not_kept.push_back(error.what());
  }
  return stream;
}

}  // namespace

SweptParameter swept_parameter(std::string_view text) {
  const std::size_t equals = text.find('=');
  SweptParameter parameter;
  if (equals != std::string_view::npos) {
    parameter.key = text.substr(0, equals);
    for (std::size_t end = equals; end < text.size();) {
      const std::size_t begin = end + 1;
      end = std::min(text.find(',', begin), text.size());
      parameter.values.emplace_back(text.substr(begin, end - begin));
    }
  }
  if (parameter.key.empty() || equals + 1 == text.size())
    throw UserError("--sweep", 0, fmt::format("\"{}\", expected KEY=VALUE,VALUE,...", text));
  if (std::ranges::find(parameter.values, "") != parameter.values.end())
    throw UserError("--sweep", 0,
                    fmt::format("\"{}\" has an empty value, expected KEY=VALUE,VALUE,...", text));
  return parameter;
}

std::vector<SweptParameter> swept_parameters(const std::vector<std::string>& texts,
                                             const std::vector<std::string>& settings) {
  std::vector<SweptParameter> parameters;
  for (const std::string& text : texts) {
    SweptParameter next = swept_parameter(text);
    if (std::ranges::find(parameters, next.key, &SweptParameter::key) != parameters.end())
      throw UserError("--sweep", 0, next.key + " is given twice, expected all its values in one --sweep");
    for (const std::string& setting : settings) {
      if (setting.starts_with(next.key + "="))
        throw UserError("--set", 0, next.key + " is swept, expected its values in --sweep alone");
    }
    parameters.push_back(std::move(next));
  }
  return parameters;
}

Sweep run_sweep(const std::string& scene_or_trace, const Machine& machine,
                const std::vector<SweptParameter>& parameters, Fidelity fidelity, const SweepOptions& options,
                const Progress& progress) {
  const auto start = HostClock::now();
  if (fidelity == Fidelity::functional)
    throw UserError("--fidelity", 0,
                    "functional has no time to sweep, expected throughput, sampled, cycle or referee");
  Sweep sweep;
  std::size_t machines = 1;
  for (const SweptParameter& parameter : parameters) {
    machines *= parameter.values.size();
    if (machines > kMostPoints)
      throw UserError("--sweep", 0, fmt::format("more than {} machines, expected fewer values", kMostPoints));
  }
  sweep.points = combine(as_held(machine, parameters));
  const std::vector<Group> groups = group(machine, sweep.points);
  const auto opened = open_input(scene_or_trace);
  std::optional<WorkCache> cache;
  if (options.cache) cache.emplace(*options.cache);
  if (options.before_work) options.before_work(opened);
  std::size_t done = 0;
  for (const Group& same : groups) {
    sweep.input = make_input(opened, scene_or_trace, same.machine);
    sweep.replaced = replace_programs(sweep.input.trace, options.programs);
    const Trace& trace = sweep.input.trace;
    if (fidelity != Fidelity::throughput && done == 0) {  // commands and size depend on no machine
      for (const SweepPoint& point : sweep.points)
        sim::expect_countable_time(trace, machine_of(machine, point));
    }
    const WorkStream stream = work_of(trace, same.machine, cache, sweep);
    const auto time_one = [&](std::size_t i) {
      const Machine timed = machine_of(machine, sweep.points[same.points[i]]);
      const sim::Result timing = time_frame(trace, stream.work, timed, fidelity, {.seed = options.seed});
      const Rate rate = rate_of(timing);
      return json_text({{"results", timing_json(timing)},
                        {"rate", {rate.fps, rate.bottleneck, rate.share}},
                        {"cycles", {timing.cycles, timing.cycles_plus_minus}}});
    };
    const auto answers = in_processes(same.points.size(), std::thread::hardware_concurrency(), time_one,
                                      [&](std::size_t n) { tell(progress, done + n, sweep.points.size()); });
    done += answers.size();
    for (std::size_t i = 0; i < answers.size(); ++i) {
      SweepPoint& point = sweep.points[same.points[i]];
      Json answer = Json::parse(answers[i]);
      point.results = std::move(answer["results"]);
      const Json& rate = answer["rate"];
      point.rate = {rate[0].get<double>(), rate[1].get<std::string>(), rate[2].get<double>()};
      point.cycles = answer["cycles"][0].get<std::uint64_t>();
      point.cycles_plus_minus = answer["cycles"][1].get<double>();
    }
  }
  if (fidelity == Fidelity::sampled) sweep.seed = options.seed;
  sweep.host_seconds = seconds_since(start);
  return sweep;
}

nlohmann::ordered_json results_of(const Sweep& sweep, const Machine& machine, Fidelity fidelity) {
  Json results = {{"input", sweep.input.name},
                  {"machine", machine.name},
                  {"set", settings_json(machine)},  // for all points
                  {"programs", programs_json(sweep.input.trace)},
                  {"fidelity", name(fidelity)}};
  if (sweep.seed) results["seed"] = *sweep.seed;
  results["points"] = Json::array();
  for (const SweepPoint& point : sweep.points) {
    Json entry = {{"set", Json::object()}};
    for (const auto& [key, value] : point.settings) entry["set"][key] = value;
    entry.update(point.results);
    results["points"].push_back(std::move(entry));
  }
  results["host"] = {{"seconds", sweep.host_seconds},
                     {"functions_computed", sweep.functions},
                     {"functions_from_cache", sweep.from_cache}};
  return results;
}

}  // namespace splatscope::studies
