#include "studies/run_observers.h"

#include <fmt/format.h>

#include <fstream>

#include "model/error.h"
#include "sim/observe/time_series.h"
#include "traces/output_files.h"
#include "traces/words.h"

namespace splatscope::studies {
namespace {

// A cycle, or `absent` for an empty text; nothing where it is neither.
std::optional<sim::Cycle> cycle_of(std::string_view text, sim::Cycle absent) {
  return text.empty() ? absent : traces::number_of<sim::Cycle>(text);
}

}  // namespace

sim::LogWindow window_of(const std::string& text, const char* option) {
  if (text.empty()) return {};
  const std::string_view view = text;
  if (const std::size_t colon = view.find(':'); colon != view.npos) {
    const auto first = cycle_of(view.substr(0, colon), 0),
               last = cycle_of(view.substr(colon + 1), sim::kNever);
    if (first && last && *first <= *last) return {*first, *last};
  }
  throw UserError(
      option, 0,
      fmt::format("\"{}\", expected FIRST:LAST, two core cycles, the first not after the last", text));
}

void check(const ObserveOptions& options) {
  for (const std::string* path : {&options.timeline, &options.pipeline, &options.counters})
    if (!path->empty()) const traces::OutputFile probe(*path);
}

struct RunObservers::File {
  explicit File(const std::string& path) : name(path), file(path), out(file.temporary(), std::ios::binary) {
    if (!out) throw UserError(path, 0, "cannot be written, expected a file in a writable folder");
  }
  std::string name;
  traces::OutputFile file;
  std::ofstream out;
  std::unique_ptr<sim::Observer> observer;
};

template <class T, class... Arguments>
T& RunObservers::add(const std::string& path, Arguments&&... arguments) {
  files_.push_back(std::make_unique<File>(path));
  auto made = std::make_unique<T>(files_.back()->out, std::forward<Arguments>(arguments)...);
  T& observer = *made;
  files_.back()->observer = std::move(made);
  observers_.push_back(&observer);
  return observer;
}

RunObservers::RunObservers(const ObserveOptions& options, const Trace& trace)
    : timeline_window_(options.timeline_window), pipeline_window_(options.pipeline_window) {
  if (!options.timeline.empty())
    timeline_ = &add<sim::Timeline>(options.timeline, trace, options.timeline_window);
  if (!options.pipeline.empty())
    pipeline_ = &add<sim::PipelineLog>(options.pipeline, trace, options.pipeline_window);
  if (!options.counters.empty()) add<sim::TimeSeries>(options.counters, options.counters_every);
}

RunObservers::~RunObservers() = default;

std::vector<std::string> RunObservers::commit(sim::Cycle cycles) {
  std::vector<std::string> said;
  for (const auto& file : files_) {
    file->out.close();
    if (!file->out) throw std::runtime_error(file->name + ": not all could be written: is the disk full?");
    file->file.commit();
    said.push_back(file->name);
  }
  const auto say_where = [&](const auto* log, const sim::LogWindow& window, const char* what,
                             const char* option) {
    if (log && window.first >= cycles)
      said.push_back(
          fmt::format("warning: the {} is empty: the run ended at cycle {}, before the first of {}", what,
                      cycles, option));
    if (!log || log->cut_at() == sim::kNever) return;
    said.push_back(fmt::format("the {} is cut short at cycle {}: {} chooses what it shows", what,
                               log->cut_at(), option));
  };
  say_where(timeline_, timeline_window_, "timeline", "--timeline-window");
  say_where(pipeline_, pipeline_window_, "pipeline log", "--pipeline-window");
  return said;
}

}  // namespace splatscope::studies
