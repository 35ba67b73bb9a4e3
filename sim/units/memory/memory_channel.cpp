#include "sim/units/memory/memory_channel.h"

#include <algorithm>
#include <bit>

namespace splatscope::sim {
namespace {

std::uint32_t log2_of(int power) {
  return static_cast<std::uint32_t>(std::countr_zero(static_cast<unsigned>(power)));
}

}  // namespace

MemoryChannel::MemoryChannel(std::string name, const Machine::Memory& spec)
    : Unit(std::move(name)),
      spec_(spec),
      burst_clocks_(static_cast<Cycle>(spec.burst_bytes / spec.channel_bytes_per_clock)),
      precharge_(static_cast<Cycle>(spec.precharge_clocks)),
      activate_(static_cast<Cycle>(spec.activate_clocks)),
      cas_(static_cast<Cycle>(spec.cas_clocks)),
      row_active_(static_cast<Cycle>(spec.row_active_clocks)),
      write_recovery_(static_cast<Cycle>(spec.write_recovery_clocks)),
      turnaround_(static_cast<Cycle>(spec.turnaround_clocks)),
      interleave_shift_(log2_of(spec.interleave_bytes)),
      row_shift_(log2_of(spec.row_bytes)),
      channel_shift_(log2_of(spec.channels)),
      bank_shift_(log2_of(spec.banks)),
      burst_shift_(log2_of(spec.burst_bytes)),
      banks_(static_cast<std::size_t>(spec.banks)) {
  queue_.reserve(static_cast<std::size_t>(spec.schedule_queue));
}

void MemoryChannel::connect(MemoryPort& port, Channel<MemoryRequest>& requests) {
  auto name = static_cast<std::uint64_t>(std::ranges::count_if(
      clients_, [&](const Client& other) { return &other.port->client() == &port.client(); }));
  for (const char letter : port.client().name()) name = 31 * name + static_cast<unsigned char>(letter);
  clients_.push_back({&port, &requests, name});
}

MemoryChannel::Entry MemoryChannel::entry_of(const MemoryRequest& request, std::size_t client) const {
  // The channel's own address: without the bits that chose the channel.
  const std::uint32_t above = request.address >> (interleave_shift_ + channel_shift_);
  const std::uint32_t row = above >> (row_shift_ - interleave_shift_);
  return {row >> bank_shift_,
          request.slot,
          static_cast<std::uint16_t>((request.bytes + (1u << burst_shift_) - 1) >> burst_shift_),
          static_cast<std::uint8_t>(row & ((1u << bank_shift_) - 1)),
          static_cast<std::uint8_t>(client),
          request.write};
}

// One request a cycle, the clients in turn.
Cycle MemoryChannel::accept(Cycle now) {
  if (is_full()) return kNever;
  const std::size_t count = clients_.size();
  std::size_t chosen = count;  // none
  Cycle next = kNever;         // of the others
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t client = turn_ + i < count ? turn_ + i : turn_ + i - count;
    const Cycle visible = clients_[client].requests->next_visible();
    if (chosen == count && visible <= now) {
      chosen = client;
    } else {
      next = std::min(next, visible);
    }
  }
  if (chosen == count) return next;
  Channel<MemoryRequest>& requests = *clients_[chosen].requests;
  queue_.push_back(entry_of(requests.pop(now), chosen));
  turn_ = chosen + 1 == count ? 0 : chosen + 1;
  return is_full() ? kNever : std::min(next, requests.next_visible());
}

// The cycle at which the request's first data can be on the bus.
Cycle MemoryChannel::earliest_data(Cycle now, const Entry& entry) const {
  const Bank& bank = banks_[entry.bank];
  Cycle access = now;
  if (bank.open_row == entry.row) {
    access = std::max(now, bank.access_from);
  } else if (bank.open_row == kNever) {
    access = now + activate_;
  } else {
    access = std::max(now, bank.precharge_from) + precharge_ + activate_;
  }
  return std::max(access + cas_, bus_free_ + (entry.write == last_was_write_ ? 0 : turnaround_));
}

// The request whose data can come first (so an open row before a closed one, and what goes on reading before
// a write), the oldest of equals; the oldest of all once it has been overtaken often enough.
std::size_t MemoryChannel::pick(Cycle now) const {
  if (bypassed_ >= spec_.bypass_limit) return 0;
  const Cycle no_wait = std::max(now + cas_, bus_free_);  // nothing can be there before
  std::size_t best = 0;
  Cycle best_data = kNever;
  for (std::size_t i = 0; best_data > no_wait && i < queue_.size(); ++i) {
    const Cycle data = earliest_data(now, queue_[i]);
    if (data < best_data) {
      best = i;
      best_data = data;
    }
  }
  return best;
}

// Opens the row of a request where it is not open.
void MemoryChannel::open_row(Cycle now, const Entry& entry) {
  Bank& bank = banks_[entry.bank];
  if (bank.open_row == entry.row) {
    ++row_hits_;
    return;
  }
  ++row_misses_;
  const Cycle activate = bank.open_row == kNever ? now : std::max(now, bank.precharge_from) + precharge_;
  bank.open_row = entry.row;
  bank.access_from = activate + activate_;
  bank.precharge_from = activate + row_active_;
}

void MemoryChannel::issue(Cycle now, std::size_t index) {
  const Entry entry = queue_[index];
  queue_.erase(queue_.begin() + static_cast<std::ptrdiff_t>(index));
  bypassed_ = index == 0 ? 0 : bypassed_ + 1;

  const Cycle first = earliest_data(now, entry);
  open_row(now, entry);
  const Cycle length = entry.bursts * burst_clocks_;
  bus_free_ = first + length;
  last_was_write_ = entry.write;
  Bank& bank = banks_[entry.bank];
  bank.access_from = first - cas_ + length;
  // What was read is on its way while the bank precharges; what is written has to arrive.
  bank.precharge_from =
      std::max(bank.precharge_from, entry.write ? bus_free_ + write_recovery_ : bank.access_from);
  data_clocks_.book(now, first, bus_free_);
  // The next is picked while there is still time to open its row before the data bus is free.
  const Cycle preparation = precharge_ + activate_ + cas_;
  next_issue_ = std::max(now + 1, bus_free_ > preparation ? bus_free_ - preparation : 0);

  event(now, (first << 16) ^ (clients_[entry.client].name << 8) ^ entry.bank);
  if (entry.write) {
    ++writes_;
    clients_[entry.client].port->written(bus_free_);
  } else {
    ++reads_;
    clients_[entry.client].port->answer(entry.slot, bus_free_ + static_cast<Cycle>(spec_.return_latency));
  }
}

Step MemoryChannel::advance(Cycle now) {
  if (!queue_.empty() && next_issue_ <= now) issue(now, pick(now));
  const Cycle next = accept(now);
  if (!queue_.empty()) return busy(std::max(std::min(next, next_issue_), now + 1));
  if (bus_free_ > now) return busy(std::min(next, bus_free_));
  return idle(next);
}

std::vector<Statistic> MemoryChannel::statistics(Cycle now) const {
  return {{"reads", "requests", "reads served", reads_},
          {"writes", "requests", "writes served", writes_},
          {"row_hits", "requests", "that found their row open", row_hits_},
          {"row_misses", "requests", "that had to open their row", row_misses_},
          {"data_clocks", "clocks", "in which the data bus carried data", data_clocks_.until(now)}};
}

std::string MemoryChannel::state() const {
  return std::to_string(queue_.size()) + " requests queued, next issue at " + std::to_string(next_issue_);
}

}  // namespace splatscope::sim
