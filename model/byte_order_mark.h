#pragma once

#include <string_view>

namespace splatscope {

// That some editors put before UTF-8.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace splatscope
