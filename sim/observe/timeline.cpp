#include "sim/observe/timeline.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <ostream>
#include <utility>

#include "sim/machine.h"

namespace splatscope::sim {
namespace {

// A number in a piece of JSON.
std::string field(const char* name, std::uint64_t value) {
  return std::string(",\"") + name + "\":" + std::to_string(value);
}

constexpr std::size_t kMostNameBytes = 200;

// Names are of units, channels and shaders. A shader's comes with the trace, as long as it likes and of any
// bytes: it is cut, between characters, and bytes that are no UTF-8 are replaced.
std::string quoted(std::string name) {
  if (name.size() > kMostNameBytes) {
    const auto is_inside = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
    std::size_t end = kMostNameBytes;
    while (end > 0 && is_inside(name[end])) --end;
    name.replace(end, std::string::npos, "...");
  }
  using nlohmann::json;
  return json(std::move(name)).dump(-1, ' ', false, json::error_handler_t::replace);
}

constexpr Cycle kCounterInterval = 256;  // cycles between two values of a counter
constexpr std::size_t kBufferBytes = 1 << 16;
constexpr std::size_t kMostDigits = 20;  // of a number
constexpr std::uint64_t kShareKept = 4;  // at most a quarter of the room is kept for one thing
constexpr std::uint32_t kCommandTrack = 0;
std::uint32_t track_of(const Unit& unit) {
  return 1 + unit.number();
}

constexpr std::string_view kSliceMiddle = ",\"dur\":", kCounterHead = ",\n{\"ph\":\"C\",\"pid\":1,\"ts\":";

std::string slice_head(std::uint32_t track) {
  return ",\n{\"ph\":\"X\",\"pid\":1" + field("tid", track) + ",\"ts\":";
}

std::string slice_tail(const std::string& name) {
  return ",\"name\":" + quoted(name) + "}";
}

std::string counter_middle(const std::string& name, const char* unit) {
  return ",\"name\":" + quoted(name) + ",\"args\":{\"" + unit + "\":";
}

std::string track_name(std::uint32_t track, const std::string& name) {
  const std::string head = ",\n{\"ph\":\"M\",\"pid\":1" + field("tid", track);
  return head + ",\"name\":\"thread_name\",\"args\":{\"name\":" + quoted(name) + "}}" + head +
         ",\"name\":\"thread_sort_index\",\"args\":{\"sort_index\":" + std::to_string(track) + "}}";
}

// Of an event of these pieces and two numbers.
std::size_t most_bytes_of(std::string_view head, std::string_view middle, std::string_view tail) {
  return head.size() + middle.size() + tail.size() + 2 * kMostDigits;
}

std::string name_of(const Trace& trace, std::size_t command) {
  const Command& what = trace.commands[command];
  if (std::holds_alternative<Clear>(what)) return "clear";
  if (std::holds_alternative<NormalizeOnHost>(what)) return "normalise on the host";
  if (std::holds_alternative<Present>(what)) return "present";
  return "draw: " + trace.programs[std::get<Draw>(what).vertex_program].name;
}

std::string command_tail(const Trace& trace, std::size_t command) {
  return slice_tail(name_of(trace, command));
}

std::uint64_t data_clocks(const Unit& memory, Cycle now) {
  const std::vector<Statistic> statistics = memory.statistics(now);
  return std::ranges::find(statistics, "data_clocks", &Statistic::name)->value;
}

}  // namespace

Timeline::Timeline(std::ostream& out, const Trace& trace, const LogWindow& window)
    : out_(out), trace_(trace), window_(window) {}

void Timeline::begin(const SimulatedMachine& machine) {
  machine_ = &machine;
  out_ << "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n{\"ph\":\"M\",\"pid\":1,\"name\":\"process_name\","
          "\"args\":{\"name\":\"splatscope (1 us = 1 core cycle)\"}}"
       << track_name(kCommandTrack, "commands");
  slice_tails_ = {slice_tail("busy"), slice_tail("starved"), slice_tail("idle")};
  for (const auto& unit : machine.units) {
    out_ << track_name(track_of(*unit), unit->name());
    slice_heads_.push_back(slice_head(track_of(*unit)));
    slice_tails_.push_back(slice_tail("blocked by " + unit->name()));
  }
  std::uint64_t commands = 0;
  for (std::size_t i = 0; i < trace_.commands.size(); ++i)
    commands += most_bytes_of(slice_head(kCommandTrack), kSliceMiddle, command_tail(trace_, i));
  for (const auto& channel : machine.channels)
    channels_.push_back({counter_middle(channel->name(), "items")});
  for (const Unit* memory : machine.memory) {
    buses_.push_back({counter_middle(memory->name() + " data bus", "% busy")});
    data_clocks_.push_back(0);
  }
  const auto longest = std::ranges::max_element(slice_tails_, {}, &std::string::size);
  std::uint64_t open = 0;  // what begins before a cut and is known behind it: a slice of each unit, the buses
  for (const std::string& head : slice_heads_) open += most_bytes_of(head, kSliceMiddle, *longest);
  for (const Counter& bus : buses_) open += most_bytes_of(kCounterHead, bus.middle, "}}");
  const auto kept = [&](std::uint64_t bytes) { return std::min(bytes, window_.most_bytes / kShareKept); };
  room_behind_cut_ = window_.most_bytes - kept(commands);
  room_ = room_behind_cut_ - kept(open);
}

void Timeline::append(std::string_view head, std::uint64_t first, std::string_view middle,
                      std::uint64_t second, std::string_view tail) {
  const std::size_t most = most_bytes_of(head, middle, tail);
  if (used_ + most > buffer_.size()) flush();
  if (most > buffer_.size()) buffer_.resize(std::max(most, kBufferBytes));
  char* const begin = buffer_.data() + used_;
  char* at = std::ranges::copy(head, begin).out;
  at = std::to_chars(at, at + kMostDigits, first).ptr;
  at = std::ranges::copy(middle, at).out;
  at = std::to_chars(at, at + kMostDigits, second).ptr;
  at = std::ranges::copy(tail, at).out;
  used_ += static_cast<std::size_t>(at - begin);
  bytes_ += static_cast<std::size_t>(at - begin);
}

void Timeline::flush() {
  out_.write(buffer_.data(), static_cast<std::streamsize>(used_));
  used_ = 0;
}

void Timeline::write(std::string_view head, Cycle first, std::string_view middle, std::uint64_t second,
                     std::string_view tail, Cycle now) {
  const std::uint64_t bytes = bytes_ + most_bytes_of(head, middle, tail);
  if (cut_at_ == kNever && bytes > room_) cut_at_ = now;
  if (first < cut_at_ && bytes <= room_behind_cut_) append(head, first, middle, second, tail);
}

// To the window; false where nothing is left.
bool Timeline::clip(Cycle& from, Cycle& until) const {
  from = std::max(from, window_.first);
  if (until > window_.last) until = window_.last + 1;
  return from < until;
}

void Timeline::booked(const Unit& unit, std::uint32_t book, Cycle from, Cycle until) {
  if (book == Step::kIdle || !clip(from, until)) return;
  if (from >= cut_at_) return;
  until = std::min(until, cut_at_);  // of one that was open there
  write(slice_heads_[unit.number()], from, kSliceMiddle, until - from, slice_tails_[book], until);
}

void Timeline::count(Counter& counter, std::uint64_t value, Cycle at, Cycle now) {
  if (value == counter.value) return;
  counter.value = value;
  write(kCounterHead, at, counter.middle, value, "}}", now);
}

// Since the last sample, however long that is: a counter holds its value from a sample on.
void Timeline::count_buses(Cycle now) {
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    const std::uint64_t clocks = data_clocks(*machine_->memory[i], now);
    if (now > sampled_at_ && sampled_at_ >= window_.first)
      count(buses_[i], 100 * (clocks - data_clocks_[i]) / (now - sampled_at_), sampled_at_, now);
    data_clocks_[i] = clocks;
  }
  sampled_at_ = now;
}

Cycle Timeline::sample(Cycle now) {
  if (now < next_sample_) return next_sample_;
  count_buses(now);
  if (now > window_.last) return next_sample_ = kNever;
  if (now < window_.first) return next_sample_ = window_.first;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    count(channels_[i], machine_->channels[i]->items(), now, now);
  }
  return next_sample_ = now + kCounterInterval;
}

void Timeline::end(const Result& result) {
  if (next_sample_ != kNever) count_buses(result.cycles);
  room_ = room_behind_cut_ = window_.most_bytes;
  const Cycle others_cut_at = std::exchange(cut_at_, kNever);
  Cycle start = 0;
  for (std::size_t i = 0; i < trace_.commands.size(); ++i) {
    Cycle from = start, until = result.command_ends[i];
    if (clip(from, until))
      write(slice_head(kCommandTrack), from, kSliceMiddle, until - from, command_tail(trace_, i), from);
    start = result.command_ends[i];
  }
  cut_at_ = std::min(cut_at_, others_cut_at);
  flush();
  out_ << "\n]}\n";
}

}  // namespace splatscope::sim
