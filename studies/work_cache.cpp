#include "studies/work_cache.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>
#include <tuple>
#include <type_traits>

#include "traces/output_files.h"
#include "traces/trace_file.h"

namespace splatscope::studies {
namespace {

constexpr std::uint64_t kMagic = 0x334b524f574c5053;  // "SPLWORK3": changes with the layout

struct Header {
  std::uint64_t magic = kMagic;
  std::uint64_t size = 0;      // bytes after the header
  std::uint64_t checksum = 0;  // of them
};

std::uint64_t hash_of(const void* bytes, std::size_t size, std::uint64_t seed) {
  return XXH64(bytes, size, seed);
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return {};
  std::string bytes(static_cast<std::size_t>(file.tellg()), '\0');
  file.seekg(0);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file ? bytes : std::string{};
}

// All of them by name: one more does not compile until it is here too.
template <class Record>
auto fields_of(Record& record) {
  if constexpr (std::is_same_v<std::remove_const_t<Record>, TriangleWork>) {
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

template <class T>
std::size_t stored_bytes() {
  if constexpr (kAsItStands<T>) {
    return sizeof(T);
  } else {
    T record;
    return std::apply([](const auto&... field) { return (sizeof field + ...); }, fields_of(record));
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
    values.resize(take_count(stored_bytes<T>()));
    if constexpr (kAsItStands<T>) {
      const std::size_t bytes = values.size() * sizeof(T);
      if (bytes > 0) std::memcpy(values.data(), next(bytes), bytes);
    } else {
      for (T& record : values) std::apply([&](auto&... field) { (take(field), ...); }, fields_of(record));
    }
  }
  // Of items that have at least so many bytes each: no more than there is text for.
  std::size_t take_count(std::size_t bytes_each) {
    std::uint64_t count = 0;
    take(count);
    if (count > text_.size() / bytes_each) throw std::out_of_range("work stream");
    return count;
  }
  bool at_end() const { return text_.empty(); }

 private:
  const char* next(std::size_t size) {
    if (size > text_.size()) throw std::out_of_range("work stream");
    const char* here = text_.data();
    text_.remove_prefix(size);
    return here;
  }
  std::string_view text_;
};

// Whether all that it names lies in the frame of `trace`.
bool fits(const DrawWork& work, const Trace& trace) {
  const auto in_frame = [&](const QuadWork& quad) {
    return 2u * quad.x < trace.width && 2u * quad.y < trace.height;
  };
  const auto is_tile = [&](const ClearTile& each) {
    return each.tile < frame_tiles(trace.width) * frame_tiles(trace.height);
  };
  return std::has_single_bit(work.sampled_runs_apart) && std::ranges::all_of(work.quads, in_frame) &&
         std::ranges::all_of(work.clear_tiles, is_tile);
}

// As `write` has it; throws std::out_of_range where the text is not that, or not of `trace`.
WorkStream stream_of(std::string_view body, const Trace& trace) {
  WorkStream stream;
  Reader reader(body);
  reader.take(stream.counters);
  stream.work.resize(reader.take_count(sizeof(std::uint32_t)));
  for (DrawWork& work : stream.work) {
    reader.take(work.command);
    reader.take(work.sampled_runs_apart);
    reader.take(work.shaded_vertices);
    reader.take(work.triangles);
    reader.take(work.quads);
    reader.take(work.texel_blocks);
    reader.take(work.clear_tiles);
    if (!fits(work, trace)) throw std::out_of_range("work stream");
  }
  if (!reader.at_end()) throw std::out_of_range("work stream");
  return stream;
}

}  // namespace

std::string work_key(const Trace& trace, const RenderOptions& options) {
  Writer text;
  const std::vector<std::byte> stored = traces::trace_bytes(trace);
  const std::string program = bytes_of("/proc/self/exe");
  // All of them by name: one more does not compile until it is here too.
  const auto& [arithmetic, color, combiner, frame, rounding, depth, subpixel_bits, filter_bits,
               reciprocal_bits] = options.formats;
  for (const int value : {int(arithmetic), int(color), int(combiner), int(frame), int(rounding), int(depth),
                          subpixel_bits, filter_bits, reciprocal_bits, options.vertex_cache_entries})
    text.add(value);
  std::string key;
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    std::uint64_t hash = hash_of(text.text().data(), text.text().size(), seed);
    hash = hash_of(stored.data(), stored.size(), hash);
    key += fmt::format("{:016x}", hash_of(program.data(), program.size(), hash));
  }
  return key;
}

WorkCache::WorkCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

std::filesystem::path WorkCache::path_of(const std::string& key) const {
  return folder_.path() / (key + ".work");
}

WorkCache::Found WorkCache::read(const std::string& key, const Trace& trace, WorkStream& stream) const {
  if (!std::filesystem::exists(path_of(key))) return Found::no;
  const std::string bytes = bytes_of(path_of(key));
  Header header;
  if (bytes.size() < sizeof header) return Found::damaged;
  std::memcpy(&header, bytes.data(), sizeof header);
  const std::string_view body = std::string_view(bytes).substr(sizeof header);
  if (header.magic != kMagic || header.size != body.size() ||
      header.checksum != hash_of(body.data(), body.size(), 0))
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
  body.add(std::uint64_t{stream.work.size()});
  for (const DrawWork& work : stream.work) {
    body.add(work.command);
    body.add(work.sampled_runs_apart);
    body.add(work.shaded_vertices);
    body.add(work.triangles);
    body.add(work.quads);
    body.add(work.texel_blocks);
    body.add(work.clear_tiles);
  }
  Writer file;
  const std::string& text = body.text();
  file.add(Header{kMagic, text.size(), hash_of(text.data(), text.size(), 0)});
  traces::write_file(path_of(key), file.text() + text);
}

}  // namespace splatscope::studies
