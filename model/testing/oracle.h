#pragma once

#include <bit>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "model/command/commands.h"

// Results from outside (tests/oracle).
namespace splatscope {

inline nlohmann::json oracle(const std::string& name) {
  return nlohmann::json::parse(std::ifstream(SPLATSCOPE_SOURCE "/tests/oracle/" + name));
}

inline float float_of(const std::string& hex) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(std::stoul(hex, nullptr, 16)));
}

inline Vec4 vector_of(const nlohmann::json& hex) {
  return {float_of(hex[0]), float_of(hex[1]), float_of(hex[2]), float_of(hex[3])};
}

}  // namespace splatscope
