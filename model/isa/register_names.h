#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "model/isa/program.h"

// Register names as text: "r0", "oPos", "oT3". Used by the assembler (in lower case) and by everything that
// prints.
namespace splatscope::isa {

struct RegisterName {
  RegisterFile file = RegisterFile::temporary;
  int index = 0;
};

// Of a lower-case name; nothing where it names no register of this kind of program. The index is not checked
// against the version's limits (the validator does that), only against kMaximumIndex.
std::optional<RegisterName> parse_register(ShaderKind kind, std::string_view name);

std::string register_name(RegisterFile file, int index);

// Usage names of `dcl_usage`, by D3DDECLUSAGE; empty where there is none.
std::string_view usage_name(int usage);
inline constexpr int kUsages = 14;
inline constexpr int kMostUsageIndex = 15;  // four bits of its token

}  // namespace splatscope::isa
