#include "studies/work_cache.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>
#include <tuple>
#include <type_traits>

#include "model/error.h"
#include "model/input_file.h"
#include "model/primitive/primitive.h"
#include "sim/draw_jobs.h"
#include "sim/observe/tile_cycles.h"
#include "traces/output_files.h"
#include "traces/trace_file.h"

namespace splatscope::studies {
namespace {

constexpr std::uint64_t kMagic = 0x344b524f574c5053;  // "SPLWORK4": changes with the layout

constexpr std::size_t kKeyDigits = 32;
using Key = std::array<char, kKeyDigits>;

struct Header {
  std::uint64_t magic = kMagic;
  Key key{};                   // a file copied to another's name is not that one
  std::uint64_t size = 0;      // bytes after the header
  std::uint64_t checksum = 0;  // of them
};

std::uint64_t hash_of(const void* bytes, std::size_t size, std::uint64_t seed) {
  return XXH64(bytes, size, seed);
}

// As a file begins; of one that is too short, zeros.
Header header_of(const std::filesystem::path& path) {
  Header header{0, {}, 0, 0};
  std::array<char, sizeof header> bytes;
  std::ifstream file(path, std::ios::binary);
  if (file.read(bytes.data(), bytes.size())) std::memcpy(&header, bytes.data(), sizeof header);
  return header;
}

Key key_of(std::string_view digits) {
  Key key{};
  std::ranges::copy(digits.substr(0, kKeyDigits), key.begin());
  return key;
}

// All of them by name: one more does not compile until it is here too.
template <class Record>
auto fields_of(Record& record) {
  if constexpr (std::is_same_v<std::remove_const_t<Record>, DrawWork>) {
    // All but the last: whole records are kept, which serve every fidelity.
    auto& [command, vertices, triangles, quads, blocks, clear_tiles, runs_apart, samples_only] = record;
    return std::tie(command, vertices, triangles, quads, blocks, clear_tiles, runs_apart);
  } else if constexpr (std::is_same_v<std::remove_const_t<Record>, TriangleWork>) {
    auto& [quads, passed, tiles, vertices, pieces, outcome] = record;
    return std::tie(quads, passed, tiles, vertices, pieces, outcome);
  } else {
    static_assert(std::is_same_v<std::remove_const_t<Record>, QuadWork>);
    auto& [x, y, covered, passed, blocks] = record;
    return std::tie(x, y, covered, passed, blocks);
  }
}

// Such values are stored as they stand in memory; of others, with padding that nobody has written, the
// fields.
template <class T>
constexpr bool kAsItStands = std::has_unique_object_representations_v<T>;

// At least; a vector has its count and may have no more.
template <class T>
std::size_t stored_bytes(const std::vector<T>&) {
  return sizeof(std::uint64_t);
}
template <class T>
std::size_t stored_bytes(const T& value) {
  if constexpr (kAsItStands<T>) {
    return sizeof value;
  } else {
    return std::apply([](const auto&... field) { return (stored_bytes(field) + ...); }, fields_of(value));
  }
}

class Writer {
 public:
  template <class T>
  void add(const T& value) {
    static_assert(kAsItStands<T>);
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(std::uint64_t{values.size()});
    if constexpr (kAsItStands<T>) {
      text_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    } else {
      for (const T& record : values)
        std::apply([&](const auto&... field) { (add(field), ...); }, fields_of(record));
    }
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// Throws std::out_of_range where the text ends too early.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}
  template <class T>
  void take(T& value) {
    static_assert(kAsItStands<T>);
    std::memcpy(&value, next(sizeof value), sizeof value);
  }
  template <class T>
  void take(std::vector<T>& values) {
    values.resize(take_count(stored_bytes(T{})));
    if constexpr (kAsItStands<T>) {
      const std::size_t bytes = values.size() * sizeof(T);
      if (bytes > 0) std::memcpy(values.data(), next(bytes), bytes);
    } else {
      for (T& record : values) std::apply([&](auto&... field) { (take(field), ...); }, fields_of(record));
    }
  }
  bool at_end() const { return text_.empty(); }

 private:
  // Of items that have at least so many bytes each: no more than there is text for.
  std::size_t take_count(std::size_t bytes_each) {
    std::uint64_t count = 0;
    take(count);
    if (count > text_.size() / bytes_each) throw std::out_of_range("work stream");
    return count;
  }
  const char* next(std::size_t size) {
    if (size > text_.size()) throw std::out_of_range("work stream");
    const char* here = text_.data();
    text_.remove_prefix(size);
    return here;
  }
  std::string_view text_;
};

bool fits(const QuadWork& quad, const Trace& trace) {
  constexpr int kAllPixels = 15, kMostBlocks = 4;
  return 2u * quad.x < trace.width && 2u * quad.y < trace.height && quad.covered <= kAllPixels &&
         (quad.passed & ~quad.covered) == 0 && quad.texel_block_count <= kMostBlocks;
}

bool fits(const TriangleWork& triangle, std::span<const QuadWork> quads, const Trace& trace) {
  const auto tiles = [](std::uint32_t pixels) -> std::uint64_t {
    return (pixels + sim::TileCycles::kTile - 1) / sim::TileCycles::kTile;
  };
  return triangle.new_vertices <= 3 && triangle.pieces <= primitive::kMaxPieces &&
         triangle.outcome <= TriangleOutcome::back_facing &&
         triangle.tile_count <= triangle.pieces * tiles(trace.width) * tiles(trace.height) &&
         (triangle.pieces != 0 || quads.empty()) &&
         std::ranges::count_if(quads, [](const QuadWork& quad) { return quad.passed != 0; }) ==
             triangle.quads_passed;
}

bool fits(const ClearTile& clear, const DrawWork& work, const Trace& trace) {
  return clear.triangle < work.triangles.size() &&
         clear.tile < frame_tiles(trace.width) * frame_tiles(trace.height);
}

// Whether `work` can be that of `draw` in `trace`.
bool fits(const DrawWork& work, const Draw& draw, const Trace& trace) {
  if (!std::has_single_bit(work.sampled_runs_apart) || !sim::adds_up(work, draw)) return false;
  std::span<const QuadWork> left = work.quads;
  for (const TriangleWork& triangle : work.triangles) {
    if (!fits(triangle, left.first(triangle.quad_count), trace)) return false;
    left = left.subspan(triangle.quad_count);
  }
  return std::ranges::all_of(work.quads, [&](const QuadWork& quad) { return fits(quad, trace); }) &&
         std::ranges::all_of(work.clear_tiles,
                             [&](const ClearTile& clear) { return fits(clear, work, trace); }) &&
         std::ranges::is_sorted(work.clear_tiles, {}, &ClearTile::triangle);
}

// Whether there is a record for each draw of `trace`, in order.
bool fits(const WorkStream& stream, const Trace& trace) {
  auto work = stream.work.begin();
  for (std::size_t command = 0; command < trace.commands.size(); ++command) {
    const Draw* draw = std::get_if<Draw>(&trace.commands[command]);
    if (!draw) continue;
    if (work == stream.work.end() || work->command != command || !fits(*work, *draw, trace)) return false;
    ++work;
  }
  return work == stream.work.end();
}

// As `write` has it; throws std::out_of_range where the text is not that, or not of `trace`.
WorkStream stream_of(std::string_view body, const Trace& trace) {
  WorkStream stream;
  Reader reader(body);
  reader.take(stream.counters);
  reader.take(stream.work);
  if (!reader.at_end() || !fits(stream, trace)) throw std::out_of_range("work stream");
  return stream;
}

}  // namespace

std::string work_key(const Trace& trace, const RenderOptions& options) {
  Writer text;
  const std::vector<std::byte> stored = traces::trace_bytes(trace, "--cache");
  constexpr const char* kProgram = "/proc/self/exe";
  const std::string program = file_bytes(kProgram);
  std::error_code error;
  if (program.empty() || program.size() != std::filesystem::file_size(kProgram, error))
    throw UserError(kProgram, 0, "cannot be read, expected this program, whose work is kept by its bytes");
  // All of them by name: one more does not compile until it is here too.
  const auto& [formats, vertex_cache_entries, record] = options;
  const auto& [arithmetic, color, combiner, frame, rounding, depth, subpixel_bits, filter_bits,
               reciprocal_bits] = formats;
  for (const int value : {int(arithmetic), int(color), int(combiner), int(frame), int(rounding), int(depth),
                          subpixel_bits, filter_bits, reciprocal_bits, vertex_cache_entries, int(record)})
    text.add(value);
  std::string key;
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    std::uint64_t hash = hash_of(text.text().data(), text.text().size(), seed);
    hash = hash_of(stored.data(), stored.size(), hash);
    key += fmt::format("{:016x}", hash_of(program.data(), program.size(), hash));
  }
  return key;
}

WorkCache::WorkCache(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  if (folder_ == "-" || !std::filesystem::is_directory(folder_, error)) made_.emplace(folder_);
}

std::filesystem::path WorkCache::path_of(const std::string& key) const {
  return folder_ / (key + ".work");
}

WorkCache::Found WorkCache::read(const std::string& key, const Trace& trace, WorkStream& stream) const {
  const std::filesystem::path path = path_of(key);
  std::error_code error;
  const std::filesystem::file_type type = std::filesystem::status(path, error).type();
  if (type == std::filesystem::file_type::not_found) return Found::no;
  if (type != std::filesystem::file_type::regular)
    throw UserError(path.string(), 0, "stands in the place of a file of the cache, expected that or nothing");
  const Header header = header_of(path);
  if (header.magic != kMagic || header.key != key_of(key) ||
      header.size != std::filesystem::file_size(path, error) - sizeof header)
    return Found::damaged;  // before memory is taken for all of it
  const std::string bytes = file_bytes(path);
  const std::string_view body = std::string_view(bytes).substr(std::min(bytes.size(), sizeof header));
  if (header.size != body.size() || header.checksum != hash_of(body.data(), body.size(), 0))
    return Found::damaged;
  try {
    stream = stream_of(body, trace);
  } catch (const std::out_of_range&) {  // of another layout or trace
    return Found::damaged;
  }
  return Found::yes;
}

void WorkCache::write(const std::string& key, const WorkStream& stream) const {
  Writer body;
  body.add(stream.counters);
  body.add(stream.work);
  Writer file;
  const std::string& text = body.text();
  file.add(Header{kMagic, key_of(key), text.size(), hash_of(text.data(), text.size(), 0)});
  traces::write_file(path_of(key), file.text() + text);
}

}  // namespace splatscope::studies
