#pragma once

#include <filesystem>
#include <string>

namespace splatscope::traces {

// A PLY mesh as assimp takes it. Its reader takes the data of elements that it does not know for those of the
// next one, loses rows to blank lines and a first byte of binary data that ends a line, and stumbles over
// comments between the lines of a header: so it gets the elements that it knows, vertices first, in rows that
// follow each other. It also hangs on some headers and fills up what is missing. Throws UserError where the
// file is not what its header says.
std::string ply_text(const std::filesystem::path& path);

}  // namespace splatscope::traces
