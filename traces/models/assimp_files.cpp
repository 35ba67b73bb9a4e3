#include "traces/models/assimp_files.h"

#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cctype>
#include <cstdint>
#include <memory>
#include <string_view>

#include "model/byte_order_mark.h"

namespace splatscope::traces {
namespace {

bool may_be_marked(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".obj" || ending == ".mtl" || ending == ".ply";
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

}  // namespace

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

Assimp::IOStream* AssimpFiles::Open(const char* file, const char* mode) {
  files_.emplace_back(file);
  if (!text_.empty() && file == mesh_)
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
  std::unique_ptr<Assimp::IOStream> stream(DefaultIOSystem::Open(file, mode));
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
