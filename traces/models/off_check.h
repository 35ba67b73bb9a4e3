#pragma once

#include <filesystem>

namespace splatscope::traces {

// assimp takes memory for the vertices and faces that the header of an OFF file counts before it looks, fills
// up what is missing of them, and passes over faces of more than 9 corners. Throws UserError where the header
// or the rows behind it are not what assimp reads wholly: rows are lines, with no comment between them.
void expect_whole_off(const std::filesystem::path& path);

}  // namespace splatscope::traces
