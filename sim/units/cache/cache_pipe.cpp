#include "sim/units/cache/cache_pipe.h"

#include <algorithm>
#include <bit>

namespace splatscope::sim {

CachePipe::CachePipe(const Spec& spec)
    : items_(static_cast<std::uint32_t>(spec.items)),
      line_bytes_(spec.line_bytes),
      fill_bytes_(spec.fill_bytes),
      tags_(spec.lines, spec.ways),
      fifo_(std::bit_ceil(items_)) {}

void CachePipe::connect(MemoryPort& port, std::uint32_t address) {
  port_ = &port;
  address_ = address;
  part_bytes_ = std::min(line_bytes_, port.interleave());
}

const Unit* CachePipe::move(Cycle now, std::uint32_t line, bool write) {
  const std::uint32_t bytes = write ? line_bytes_ : fill_bytes_;
  for (; moved_ < bytes; moved_ += part_bytes_) {
    const std::uint32_t address = address_ + line * line_bytes_ + moved_;
    if (const Unit* unit = port_->in_the_way(now, address)) {
      next_try_ = port_->next_free(address);
      return unit;
    }
    if (write) {
      port_->write(now, address, part_bytes_);
    } else {
      port_->read(now, address, std::min(part_bytes_, fill_bytes_));
      ++entering_reads_;
    }
  }
  moved_ = 0;
  return nullptr;
}

const Unit* CachePipe::touch(Cycle now, std::uint32_t line, bool fetch, bool dirty) {
  if (CacheTags::Way* way = tags_.find(line)) {
    ++touches_;
    tags_.use(*way, dirty);
    return nullptr;
  }
  CacheTags::Way& way = tags_.victim(line);
  if (way.dirty) {
    if (const Unit* unit = move(now, way.line, true)) return unit;
    ++write_backs_;
    way.dirty = false;
  }
  if (fetch) {
    if (const Unit* unit = move(now, line, false)) return unit;
  }
  ++touches_;
  ++misses_;
  tags_.take(way, line, dirty);
  return nullptr;
}

void CachePipe::pass(std::uint32_t line, bool dirty) {
  if (CacheTags::Way* way = tags_.find(line)) return tags_.use(*way, dirty);
  tags_.take(tags_.victim(line), line, dirty);
}

void CachePipe::enter(std::uint32_t item) {
  fifo_[tail_++ & (fifo_.size() - 1)] = {item, entering_reads_};
  entering_reads_ = 0;
}

bool CachePipe::is_ready(Cycle now) {
  Waiting& waiting = fifo_[head_ & (fifo_.size() - 1)];
  while (waiting.reads != 0 && port_->oldest_ready() <= now) {
    port_->release_oldest();
    --waiting.reads;
  }
  return waiting.reads == 0;
}

Cycle CachePipe::next_ready() {
  const Cycle ready = port_->oldest_ready();
  if (ready == kNever) port_->await_oldest();
  return ready;
}

bool CachePipe::flush(Cycle now) {
  for (; flush_at_ < tags_.all().size(); ++flush_at_) {
    CacheTags::Way& way = tags_.all()[flush_at_];
    if (!way.dirty) continue;
    if (move(now, way.line, true)) {
      next_flush_ = next_try_;
      return true;
    }
    ++write_backs_;
    way.dirty = false;
    next_flush_ = now + 1;
    return true;
  }
  next_flush_ = port_->writes_done();
  if (next_flush_ == kNever) port_->await_writes();
  if (next_flush_ > now) return true;
  flush_at_ = 0;
  return false;
}

void CachePipe::invalidate(std::uint32_t end) {
  tags_.invalidate(end);
}

}  // namespace splatscope::sim
