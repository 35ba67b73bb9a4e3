#pragma once

#include <span>
#include <string_view>

namespace splatscope {

// A text file of the source tree that is part of the program (cmake/targets.cmake, splatscope_embed).
struct EmbeddedFile {
  std::string_view name;  // without its folder: "splat_ewa.vs"
  std::string_view text;
};

}  // namespace splatscope
