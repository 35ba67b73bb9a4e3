#pragma once

#include <bit>
#include <vector>

#include "sim/kernel/channel.h"

namespace splatscope::sim {

struct MemoryRequest {
  std::uint32_t address = 0;  // bytes
  std::uint32_t slot = 0;     // where the answer goes
  std::uint32_t bytes = 0;    // up to memory.interleave_bytes
  bool write = false;
};

// A unit's way to memory: a request channel to each memory channel, and return slots that carry the cycle at
// which their data is there. Reads are numbered; number n has slot n % slots until it is released, and reads
// are released in order. What a read is for is the client's business.
class MemoryPort {
 public:
  // `slots`: reads in flight at most (rounded up to a power of two).
  MemoryPort(Unit& client, std::uint32_t slots)
      : client_(client), mask_(std::bit_ceil(slots) - 1), returns_(mask_ + 1) {}

  // Request channels in the order of the memory channels; consecutive `interleave` bytes go to one of them.
  void connect(std::vector<Channel<MemoryRequest>*> channels, std::uint32_t interleave) {
    channels_ = std::move(channels);
    shift_ = static_cast<std::uint32_t>(std::countr_zero(interleave));
  }
  std::uint32_t interleave() const { return std::uint32_t{1} << shift_; }

  // nullptr: a request to `address` can be made; else the unit in the way.
  const Unit* in_the_way(Cycle now, std::uint32_t address) const {
    const auto& channel = channel_of(address);
    return channel.can_push(now) ? nullptr : &channel.consumer();
  }
  // When the channel of `address` has room; kNever: its consumer will wake the client.
  Cycle next_free(std::uint32_t address) const { return channel_of(address).next_free(); }

  // Asks for `bytes`, all of one memory channel. The caller has checked in_the_way() and keeps to its slots.
  void read(Cycle now, std::uint32_t address, std::uint32_t bytes) {
    const auto slot = static_cast<std::uint32_t>(next_read_++ & mask_);
    returns_[slot] = {kNever, &channel_of(address).consumer()};
    channel_of(address).push(now, {address, slot, bytes, false});
  }
  void write(Cycle now, std::uint32_t address, std::uint32_t bytes) {
    ++writes_in_flight_;
    channel_of(address).push(now, {address, 0, bytes, true});
  }

  // The oldest read not released: when its data is there (kNever: not known yet; then await_oldest() has the
  // client woken).
  Cycle oldest_ready() const { return returns_[oldest_ & mask_].ready; }
  const Unit& oldest_server() const { return *returns_[oldest_ & mask_].server; }
  void await_oldest() { awaited_ = oldest_ & mask_; }
  void release_oldest() { ++oldest_; }

  // When the last write has reached memory; kNever: some are on their way (after await_writes() the last
  // wakes the client).
  Cycle writes_done() const { return writes_in_flight_ == 0 ? last_write_ : kNever; }
  void await_writes() { writes_awaited_ = true; }

  // The memory's side.
  Unit& client() const { return client_; }
  void answer(std::uint32_t slot, Cycle at) {
    returns_[slot].ready = at;
    if (slot == awaited_) client_.wake(at);
  }
  void written(Cycle at) {
    if (at > last_write_) last_write_ = at;
    if (--writes_in_flight_ != 0 || !writes_awaited_) return;
    writes_awaited_ = false;
    client_.wake(last_write_);
  }

 private:
  struct Return {
    Cycle ready = kNever;
    const Unit* server = nullptr;
  };

  Channel<MemoryRequest>& channel_of(std::uint32_t address) const {
    return *channels_[(address >> shift_) & (channels_.size() - 1)];
  }

  Unit& client_;
  std::vector<Channel<MemoryRequest>*> channels_;
  std::uint32_t shift_ = 6;
  std::uint64_t mask_;
  std::uint64_t next_read_ = 0;
  std::uint64_t oldest_ = 0;
  std::uint64_t awaited_ = kNever;
  std::vector<Return> returns_;
  std::uint64_t writes_in_flight_ = 0;
  Cycle last_write_ = 0;
  bool writes_awaited_ = false;
};

}  // namespace splatscope::sim
