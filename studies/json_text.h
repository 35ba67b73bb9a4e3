#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace splatscope::studies {

// `json` as text, with so many spaces a level; -1: on one line. Bytes that are no UTF-8, as the name of a
// file or a program may have, are written as U+FFFD: JSON cannot hold them, and no result is worth losing for
// them.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

// The text with U+FFFD for the bytes that are no UTF-8, as there.
std::string valid_utf8(std::string_view text);

}  // namespace splatscope::studies
