#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace splatscope::sim {

// Which lines a set-associative cache holds; the least recently used of a set goes.
class CacheTags {
 public:
  static constexpr std::uint32_t kNoLine = ~std::uint32_t{0};
  struct Way {
    std::uint32_t line = kNoLine;
    std::uint32_t used = 0;
    bool dirty = false;
  };

  // Both powers of two, ways at most lines.
  CacheTags(int lines, int ways)
      : ways_(static_cast<std::uint32_t>(ways)),
        set_mask_(static_cast<std::uint32_t>(lines / ways) - 1),
        tags_(static_cast<std::size_t>(lines)) {}

  // Null where the line is not held. Looks at every way: which one it is cannot be foreseen.
  Way* find(std::uint32_t line) {
    Way* set = set_of(line);
    Way* found = nullptr;
    for (std::uint32_t way = 0; way < ways_; ++way) found = set[way].line == line ? &set[way] : found;
    return found;
  }
  // The way that `line` will have: an empty one, else the least recently used of its set.
  Way& victim(std::uint32_t line) {
    Way* set = set_of(line);
    Way* oldest = set;
    for (std::uint32_t way = 0; way < ways_; ++way) {
      if (set[way].line == kNoLine) return set[way];
      if (set[way].used < oldest->used) oldest = &set[way];
    }
    return *oldest;
  }
  void use(Way& way, bool dirty) {
    way.used = ++clock_;
    way.dirty |= dirty;
  }
  void take(Way& way, std::uint32_t line, bool dirty) { way = {line, ++clock_, dirty}; }

  std::span<Way> all() { return tags_; }
  // Drops the lines below `end`.
  void invalidate(std::uint32_t end) {
    for (Way& way : tags_) {
      if (way.line < end) way = {};
    }
  }

 private:
  Way* set_of(std::uint32_t line) { return &tags_[std::size_t{line & set_mask_} * ways_]; }

  std::uint32_t ways_;
  std::uint32_t set_mask_;
  // Of uses. After 2^32 of them, 16 s of the machine at one in each clock of 275 MHz, it begins again: what
  // lies there from before is then the last to go until it is used again. 64 bits would make a way a third
  // larger.
  std::uint32_t clock_ = 0;
  std::vector<Way> tags_;  // a set's ways side by side
};

}  // namespace splatscope::sim
