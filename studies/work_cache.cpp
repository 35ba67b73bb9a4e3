#include "studies/work_cache.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstring>
#include <fstream>
#include <span>
#include <type_traits>

#include "traces/output_files.h"
#include "traces/trace_file.h"

namespace splatscope::studies {
namespace {

constexpr std::uint64_t kMagic = 0x314b524f574c5053;  // "SPLWORK1": changes with the layout

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

class Writer {
 public:
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const char* bytes = reinterpret_cast<const char*>(&value);
    text_.append(bytes, sizeof value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(std::uint64_t{values.size()});
    text_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}
  template <class T>
  void take(T& value) {
    std::memcpy(&value, next(sizeof value), sizeof value);
  }
  template <class T>
  void take(std::vector<T>& values) {
    std::uint64_t count = 0;
    take(count);
    if (count > text_.size() / sizeof(T)) throw std::out_of_range("work stream");
    values.resize(count);
    if (count > 0) std::memcpy(static_cast<void*>(values.data()), next(count * sizeof(T)), count * sizeof(T));
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

WorkCache::Found WorkCache::read(const std::string& key, WorkStream& stream) const {
  if (!std::filesystem::exists(path_of(key))) return Found::no;
  const std::string bytes = bytes_of(path_of(key));
  Header header;
  if (bytes.size() < sizeof header) return Found::damaged;
  std::memcpy(&header, bytes.data(), sizeof header);
  const std::string_view body = std::string_view(bytes).substr(sizeof header);
  if (header.magic != kMagic || header.size != body.size() ||
      header.checksum != hash_of(body.data(), body.size(), 0))
    return Found::damaged;
  Reader reader(body);
  std::uint64_t draws = 0;
  reader.take(stream.counters);
  reader.take(draws);
  stream.work.resize(draws);
  for (DrawWork& work : stream.work) {
    reader.take(work.command);
    reader.take(work.shaded_vertices);
    reader.take(work.triangles);
    reader.take(work.quads);
    reader.take(work.texel_blocks);
  }
  return reader.at_end() ? Found::yes : Found::damaged;
}

void WorkCache::write(const std::string& key, const WorkStream& stream) const {
  Writer body;
  body.add(stream.counters);
  body.add(std::uint64_t{stream.work.size()});
  for (const DrawWork& work : stream.work) {
    body.add(work.command);
    body.add(work.shaded_vertices);
    body.add(work.triangles);
    body.add(work.quads);
    body.add(work.texel_blocks);
  }
  Writer file;
  const std::string& text = body.text();
  file.add(Header{kMagic, text.size(), hash_of(text.data(), text.size(), 0)});
  traces::write_file(path_of(key), file.text() + text);
}

}  // namespace splatscope::studies
