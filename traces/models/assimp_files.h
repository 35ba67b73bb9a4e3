#pragma once

#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <vector>

namespace splatscope::traces {

// How assimp reads files here: without the byte order mark that some editors put before a text, which its
// readers of OBJ and PLY stumble over; and each is noted in `files`, also where it cannot be opened.
class AssimpFiles : public Assimp::DefaultIOSystem {
 public:
  explicit AssimpFiles(std::vector<std::filesystem::path>& files) : files_(files) {}

  Assimp::IOStream* Open(const char* file, const char* mode) override;

 private:
  std::vector<std::filesystem::path>& files_;
};

}  // namespace splatscope::traces
