#pragma once

#include <vector>

#include "sim/units/cache/cache_tags.h"
#include "sim/units/memory/memory_port.h"

namespace splatscope::sim {

// A pipelined cache (Igehy, Eldridge and Proudfoot 1998): tags are checked when an item enters and its misses
// are asked for at once; items then wait in a FIFO and leave in order when their lines are there, so that
// memory latency costs slots of the FIFO and no time. An item that hits a line which an earlier one asked for
// leaves after it and so needs no further wait. Lines are replaced, and dirty ones written back, when the tag
// is taken.
class CachePipe {
 public:
  struct Spec {
    int lines;                 // a power of two
    int ways;                  // a power of two, at most `lines`; least recently used goes
    std::uint32_t line_bytes;  // a power of two
    std::uint32_t fill_bytes;  // read of a line on a miss
    int items;                 // waiting
  };
  explicit CachePipe(const Spec& spec);

  // The port to take lines from, and the address of line 0. The cache keeps what it holds; invalidate()
  // empties it.
  void connect(MemoryPort& port, std::uint32_t address);
  // Reads this much of a line on a miss from now on.
  void set_fill(std::uint32_t bytes) { fill_bytes_ = bytes; }

  bool has_room() const { return tail_ - head_ < items_; }

  // Touches a line for the item that enters next. nullptr: done; else the unit in the way, and the client
  // tries the same line again (what has gone out by then is remembered). `fetch`: a miss reads the line from
  // memory. `dirty`: the item writes to it.
  const Unit* touch(Cycle now, std::uint32_t line, bool fetch, bool dirty);
  // When touch() is worth another try after it failed; kNever: a memory channel will wake the client.
  Cycle next_try() const { return next_try_; }
  void enter(std::uint32_t item);

  // The oldest item.
  bool empty() const { return head_ == tail_; }
  std::uint32_t oldest() const { return fifo_[head_ & (fifo_.size() - 1)].item; }
  // Whether its lines are there. Takes note of those that came.
  bool is_ready(Cycle now);
  // After is_ready() said no: who serves the line that it waits for, and when that comes (kNever: not known
  // yet, the memory wakes the client).
  const Unit& server() const { return port_->oldest_server(); }
  Cycle next_ready();
  std::uint32_t leave() { return fifo_[head_++ & (fifo_.size() - 1)].item; }

  // Touches a line in the tags alone, in no time: for what a sampled draw leaves out. Between items only.
  void pass(std::uint32_t line, bool dirty);

  // Writes one dirty line back, if there is one. False: none is left, and all writes have reached memory.
  bool flush(Cycle now);
  Cycle next_flush() const { return next_flush_; }
  // Drops the lines below `end`, as they are.
  void invalidate(std::uint32_t end = CacheTags::kNoLine);

  std::uint64_t touches() const { return touches_; }
  std::uint64_t misses() const { return misses_; }
  std::uint64_t write_backs() const { return write_backs_; }

 private:
  struct Waiting {
    std::uint32_t item = 0;
    std::uint32_t reads = 0;
  };

  // Asks memory to move `line`, part by part where it spans memory channels. nullptr: all asked for; else the
  // unit in the way, and the next call goes on from there.
  const Unit* move(Cycle now, std::uint32_t line, bool write);

  std::uint32_t items_;
  std::uint32_t line_bytes_;
  std::uint32_t fill_bytes_;
  std::uint32_t part_bytes_ = 0;
  CacheTags tags_;
  MemoryPort* port_ = nullptr;
  std::uint32_t address_ = 0;
  std::vector<Waiting> fifo_;
  std::uint64_t head_ = 0, tail_ = 0;
  std::uint32_t entering_reads_ = 0;
  std::uint32_t moved_ = 0;  // bytes of the line that move() is at
  Cycle next_try_ = 0;
  std::size_t flush_at_ = 0;
  Cycle next_flush_ = 0;
  std::uint64_t touches_ = 0, misses_ = 0, write_backs_ = 0;
};

}  // namespace splatscope::sim
