#include "traces/models/assimp_files.h"

#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string_view>

#include "model/byte_order_mark.h"

namespace splatscope::traces {
namespace {

bool may_be_marked(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".obj" || ending == ".mtl";
}

// A file from behind its byte order mark on.
class Unmarked : public Assimp::IOStream {
 public:
  explicit Unmarked(std::unique_ptr<Assimp::IOStream> whole) : whole_(std::move(whole)) {}

  size_t Read(void* to, size_t size, size_t count) override { return whole_->Read(to, size, count); }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    return whole_->Seek(origin == aiOrigin_SET ? offset + kByteOrderMark.size() : offset, origin);
  }
  size_t Tell() const override { return whole_->Tell() - kByteOrderMark.size(); }
  size_t FileSize() const override { return whole_->FileSize() - kByteOrderMark.size(); }
  void Flush() override {}

 private:
  std::unique_ptr<Assimp::IOStream> whole_;
};

// %20 and the like as the bytes that they stand for.
std::string percent_decoded(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view digits = text.substr(i + 1, 2);
    unsigned byte = 0;
    const char* const end = digits.data() + digits.size();
    const bool is_code =
        text[i] == '%' && digits.size() == 2 && std::from_chars(digits.data(), end, byte, 16).ptr == end;
    bytes += is_code ? static_cast<char>(byte) : text[i];
    if (is_code) i += 2;
  }
  return bytes;
}

}  // namespace

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

std::filesystem::path file_named(std::string name, const std::filesystem::path& folder) {
  std::ranges::replace(name, '\\', '/');
  std::filesystem::path as_it_stands = folder / name;
  std::error_code error;
  if (std::filesystem::exists(as_it_stands, error)) return as_it_stands;
  for (const std::string& other : {name.substr(0, name.find_last_not_of(" \t") + 1), percent_decoded(name)})
    if (!other.empty() && std::filesystem::exists(folder / other, error)) return folder / other;
  return as_it_stands;
}

Assimp::IOStream* AssimpFiles::Open(const char* name, const char* mode) {
  const std::string folder = (mesh_.parent_path() / "").string();
  std::string_view in_folder = name;
  if (in_folder.starts_with(folder)) in_folder.remove_prefix(folder.size());
  const std::string file = name == mesh_ ? name : file_named(std::string(in_folder), folder).string();
  files_.emplace_back(file);
  if (!text_.empty() && file == mesh_)
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
  std::unique_ptr<Assimp::IOStream> stream(DefaultIOSystem::Open(file.c_str(), mode));
  if (!stream || !may_be_marked(file)) return stream.release();
  char start[kByteOrderMark.size()];
  const bool marked =
      stream->Read(start, sizeof(start), 1) == 1 && std::string_view(start, sizeof(start)) == kByteOrderMark;
  if (marked)
    stream = std::make_unique<Unmarked>(std::move(stream));
  else
    stream->Seek(0, aiOrigin_SET);
  return stream.release();
}

}  // namespace splatscope::traces
