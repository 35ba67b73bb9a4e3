#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/command/commands.h"
#include "sim/kernel/observer.h"
#include "sim/observe/pipeline_log.h"
#include "sim/observe/timeline.h"

// Files that a run writes while it goes on, about what happens in the machine.
namespace splatscope::studies {

// "1000:2000", "1000:", ":2000" or "": the first and the last core cycle. Throws UserError (file `option`)
// for anything else.
sim::LogWindow window_of(const std::string& text, const char* option);

struct ObserveOptions {
  std::string timeline;                   // file for Perfetto; empty: none
  sim::LogWindow timeline_window;         // what it shows
  std::string pipeline;                   // file for Konata; empty: none
  sim::LogWindow pipeline_window;         // the same of it
  std::string counters;                   // file for a table (CSV); empty: none
  std::uint64_t counters_every = 10'000;  // core cycles a row

  bool asks_for_cycles() const { return !timeline.empty() || !pipeline.empty() || !counters.empty(); }
};

// Throws UserError where a file cannot be made: what RunObservers would say only once there is a trace.
void check(const ObserveOptions& options);

class RunObservers {
 public:
  // Of a run of `trace`, which outlives them. Throws UserError where a file cannot be made.
  RunObservers(const ObserveOptions& options, const Trace& trace);
  ~RunObservers();

  std::span<sim::Observer* const> observers() const { return observers_; }
  // After the run of so many cycles: the files take their places. Throws std::runtime_error where not all
  // could be written. Returns lines that say what was written.
  std::vector<std::string> commit(sim::Cycle cycles);

 private:
  struct File;
  template <class T, class... Arguments>
  T& add(const std::string& path, Arguments&&... arguments);

  sim::LogWindow timeline_window_, pipeline_window_;
  std::vector<std::unique_ptr<File>> files_;
  std::vector<sim::Observer*> observers_;
  const sim::Timeline* timeline_ = nullptr;
  const sim::PipelineLog* pipeline_ = nullptr;
};

}  // namespace splatscope::studies
