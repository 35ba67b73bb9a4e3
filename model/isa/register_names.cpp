#include "model/isa/register_names.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

#include "model/isa/opcode.h"

namespace splatscope::isa {
namespace {

struct FileName {
  std::string_view prefix;      // as printed
  std::string_view lower_case;  // as parsed
  RegisterFile file;
  bool numbered;
  bool vertex, pixel;
};

constexpr FileName kFiles[] = {
    {"oPos", "opos", RegisterFile::position_out, false, true, false},
    {"oFog", "ofog", RegisterFile::fog_out, false, true, false},
    {"oPts", "opts", RegisterFile::point_size_out, false, true, false},
    {"oD", "od", RegisterFile::color_out, true, true, false},
    {"oT", "ot", RegisterFile::texcoord_out, true, true, false},
    {"r", "r", RegisterFile::temporary, true, true, true},
    {"v", "v", RegisterFile::input, true, true, true},
    {"c", "c", RegisterFile::constant, true, true, true},
    {"a", "a", RegisterFile::address, true, true, false},
    {"t", "t", RegisterFile::texture, true, false, true},
};

constexpr std::array<std::string_view, kUsages> kUsageNames = {
    "position", "blendweight", "blendindices", "normal", "psize", "texcoord", "tangent",
    "binormal", "tessfactor",  "positiont",    "color",  "fog",   "depth",    "sample"};

}  // namespace

std::optional<RegisterName> parse_register(ShaderKind kind, std::string_view name) {
  for (const FileName& candidate : kFiles) {
    if (!name.starts_with(candidate.lower_case)) continue;
    if (!(kind == ShaderKind::vertex ? candidate.vertex : candidate.pixel)) continue;
    const std::string_view digits = name.substr(candidate.lower_case.size());
    if (!candidate.numbered) {
      if (digits.empty()) return RegisterName{candidate.file, 0};
      continue;
    }
    int index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size()) continue;
    if (index < 0 || index > kMaximumIndex) continue;
    return RegisterName{candidate.file, index};
  }
  return std::nullopt;
}

std::string register_name(RegisterFile file, int index) {
  for (const FileName& candidate : kFiles)
    if (candidate.file == file)
      return candidate.numbered ? fmt::format("{}{}", candidate.prefix, index)
                                : std::string(candidate.prefix);
  return "?";
}

std::string_view usage_name(int usage) {
  return usage >= 0 && usage < kUsages ? kUsageNames[static_cast<std::size_t>(usage)] : std::string_view{};
}

}  // namespace splatscope::isa
