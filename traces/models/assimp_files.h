#pragma once

#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <string>
#include <vector>

namespace splatscope::traces {

// Of a file's name, in small letters: ".obj".
std::string ending_of(const std::filesystem::path& path);

// The file in `folder` that a mesh calls `name`: with / in the place of \, as it stands or, where there is
// none of that name, without blanks behind it, or as the percent-encoded URI that glTF prescribes
// ("my%20skin.png").
std::filesystem::path file_named(std::string name, const std::filesystem::path& folder);

// How assimp reads files here: by `file_named`; .obj and .mtl without the byte order mark that some editors
// put before a text, which its readers of these stumble over (in a binary file the same bytes are data);
// `mesh` as `text`, where that is not empty; and each is noted in `files`, also where it cannot be
// opened.
class AssimpFiles : public Assimp::DefaultIOSystem {
 public:
  AssimpFiles(std::vector<std::filesystem::path>& files, std::filesystem::path mesh, std::string text)
      : files_(files), mesh_(std::move(mesh)), text_(std::move(text)) {}

  Assimp::IOStream* Open(const char* file, const char* mode) override;

 private:
  std::vector<std::filesystem::path>& files_;
  std::filesystem::path mesh_;
  std::string text_;
};

}  // namespace splatscope::traces
