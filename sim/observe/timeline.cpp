#include "sim/observe/timeline.h"

#include <algorithm>
#include <ostream>

#include "sim/machine.h"
#include "sim/units/memory/memory_channel.h"

namespace splatscope::sim {
namespace {

// A number in a piece of JSON.
std::string field(const char* name, std::uint64_t value) {
  return std::string(",\"") + name + "\":" + std::to_string(value);
}

// Names are of units, channels and shaders. A shader's comes with the trace: what JSON would trip over goes.
std::string quoted(const std::string& name) {
  std::string out = "\"";
  for (const char c : name) out += static_cast<unsigned char>(c) < 0x20 || c == '"' || c == '\\' ? '_' : c;
  return out + '"';
}

constexpr std::uint32_t kCommandTrack = 0;
std::uint32_t track_of(const Unit& unit) {
  return 1 + unit.number();
}

std::string track_name(std::uint32_t track, const std::string& name) {
  const std::string head = ",\n{\"ph\":\"M\",\"pid\":1" + field("tid", track);
  return head + ",\"name\":\"thread_name\",\"args\":{\"name\":" + quoted(name) + "}}" + head +
         ",\"name\":\"thread_sort_index\",\"args\":{\"sort_index\":" + std::to_string(track) + "}}";
}

std::string name_of(const Trace& trace, std::size_t command) {
  const Command& what = trace.commands[command];
  if (std::holds_alternative<Clear>(what)) return "clear";
  if (std::holds_alternative<NormalizeOnHost>(what)) return "normalise on the host";
  if (std::holds_alternative<Present>(what)) return "present";
  return "draw: " + trace.programs[std::get<Draw>(what).vertex_program].name;
}

std::uint64_t data_clocks(const Unit& memory) {
  const std::vector<Statistic> statistics = memory.statistics();
  return std::ranges::find(statistics, "data_clocks", &Statistic::name)->value;
}

}  // namespace

Timeline::Timeline(std::ostream& out, const Trace& trace, const Window& window)
    : out_(out), trace_(trace), window_(window) {}

void Timeline::begin(const SimulatedMachine& machine) {
  machine_ = &machine;
  out_ << "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n{\"ph\":\"M\",\"pid\":1,\"name\":\"process_name\","
          "\"args\":{\"name\":\"splatscope (1 us = 1 core cycle)\"}}"
       << track_name(kCommandTrack, "commands");
  for (const auto& unit : machine.units) out_ << track_name(track_of(*unit), unit->name());
  for (const auto& channel : machine.channels) channels_.push_back({.name = channel->name()});
  for (const Unit* memory : machine.memory) {
    buses_.push_back({.name = memory->name() + " data bus"});
    data_clocks_.push_back(0);
  }
}

void Timeline::write(const std::string& event, Cycle at) {
  if (cut_at_ != kNever) return;
  if (bytes_ + event.size() > window_.most_bytes) {
    cut_at_ = at;
    return;
  }
  bytes_ += event.size();
  out_ << event;
}

std::string Timeline::slice(std::uint32_t track, const std::string& name, Cycle from, Cycle until) const {
  from = std::max(from, window_.first);
  if (until > window_.last) until = window_.last + 1;
  if (from >= until) return {};
  return ",\n{\"ph\":\"X\",\"pid\":1" + field("tid", track) + field("ts", from) + field("dur", until - from) +
         ",\"name\":" + quoted(name) + "}";
}

void Timeline::booked(const Unit& unit, std::uint32_t book, Cycle from, Cycle until) {
  if (until <= window_.first || from > window_.last || book == Step::kIdle) return;
  const std::string name = book == Step::kBusy ? "busy"
                           : book == Step::kStarved
                               ? "starved"
                               : "blocked by " + machine_->units[book - Step::kBlocked]->name();
  write(slice(track_of(unit), name, from, until), from);
}

void Timeline::count(Counter& counter, const char* unit, std::uint64_t value, Cycle now) {
  if (value == counter.value) return;
  counter.value = value;
  write(",\n{\"ph\":\"C\",\"pid\":1" + field("ts", now) + ",\"name\":" + quoted(counter.name) +
            ",\"args\":{\"" + unit + "\":" + std::to_string(value) + "}}",
        now);
}

Cycle Timeline::sample(Cycle now) {
  if (now > window_.last) return kNever;
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    const std::uint64_t clocks = data_clocks(*machine_->memory[i]);
    if (now > sampled_at_ && sampled_at_ >= window_.first) {
      count(buses_[i], "% busy", 100 * (clocks - data_clocks_[i]) / (now - sampled_at_), now);
    }
    data_clocks_[i] = clocks;
  }
  sampled_at_ = now;
  if (now < window_.first) return window_.first;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    count(channels_[i], "items", machine_->channels[i]->items(), now);
  }
  return now + window_.counter_interval;
}

void Timeline::end(const Result& result) {
  Cycle start = 0;
  for (std::size_t i = 0; i < trace_.commands.size(); ++i) {
    out_ << slice(kCommandTrack, name_of(trace_, i), start, result.command_ends[i]);
    start = result.command_ends[i];
  }
  out_ << "\n]}\n";
}

}  // namespace splatscope::sim
