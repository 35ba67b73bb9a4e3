#pragma once

#include <filesystem>
#include <string>

namespace splatscope::traces {

// An OBJ file as assimp takes it. Its reader counts the numbers of a line by their first characters, without
// .5, nan and inf, and leaves out a vertex of which it counts another number than 3, 4 or 6, so that all
// later indices mean other vertices: such words get a sign. It also leaves out lines that begin with blanks,
// and stumbles over comments behind numbers and faces and over a byte order mark: they go. Empty where the
// file needs no change. Throws UserError where a vertex has another number of numbers, or a word that is
// none.
std::string obj_text(const std::filesystem::path& path);

}  // namespace splatscope::traces
