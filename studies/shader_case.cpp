#include "studies/shader_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/tokens.h"
#include "model/isa/validate.h"

namespace splatscope::studies {
namespace {

using nlohmann::ordered_json;

constexpr int kDepth = 8;                 // of JSON; a case needs 2
constexpr std::size_t kLongestText = 32;  // of what a message quotes

std::string quote_of(std::string_view text) {
  if (text.size() <= kLongestText) return fmt::format("\"{}\"", text);
  return fmt::format("\"{}...\"", text.substr(0, kLongestText));
}

}  // namespace

ordered_json parse_case(std::string_view text, std::string_view file, int line) {
  using Event = ordered_json::parse_event_t;
  std::vector<std::set<std::string>> keys;  // of the objects that are open
  std::string twice;                        // the first of these that stands there already
  const auto check = [&](int depth, Event event, ordered_json& parsed) {
    if (depth > kDepth)
      throw NoCase(file, line, fmt::format("this is nested deeper than {}, expected a case", kDepth));
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key && !keys.back().insert(parsed.get<std::string>()).second && twice.empty())
      twice = quote_of(parsed.get_ref<const std::string&>());
    return true;
  };
  ordered_json object = ordered_json::parse(text, check, false);
  if (!object.is_object()) throw NoCase(file, line, "this is no JSON object, expected a case");
  if (!twice.empty())
    throw UserError(file, line, fmt::format("the key {} stands twice in an object, expected it once", twice));
  return object;
}

ordered_json hex_of(const Vec4& value) {
  ordered_json words = ordered_json::array();
  for (const float component : value)
    words.push_back(fmt::format("{:08x}", std::bit_cast<std::uint32_t>(component)));
  return words;
}

bool is_case_id(const ordered_json& id) {
  return id.is_string() || id.is_number();
}

ShaderCase::ShaderCase(std::string_view text, std::string_view file, int line)
    : ShaderCase(file, line, parse_case(text, file, line)) {}

ShaderCase ShaderCase::of_object(ordered_json object, std::string_view file, int line) {
  return {file, line, std::move(object)};
}

ShaderCase::ShaderCase(std::string_view file, int line, ordered_json object)
    : case_(std::move(object)), file_(file), line_(line) {
  constexpr std::string_view kKeys[] = {"id",     "program",   "tokens",   "constants",
                                        "inputs", "texcoords", "textures", "bump"};
  for (const auto& [key, value] : case_.items())
    if (std::ranges::find(kKeys, key) == std::end(kKeys))
      fail(fmt::format("unknown key {}, expected one of {}", quote_of(key), fmt::join(kKeys, ", ")));
  if (case_.contains("id") && !is_case_id(case_["id"])) fail("\"id\" is neither text nor a number");
}

void ShaderCase::fail(std::string_view message) const {
  throw UserError(file_, line_, message);
}

isa::Program ShaderCase::program(std::string_view name) const {
  if (case_.contains("program") == case_.contains("tokens")) fail("expected \"program\" or \"tokens\"");
  if (case_.contains("program")) {
    if (!case_["program"].is_string()) fail("\"program\" is no text, expected assembly");
    return isa::load(case_["program"].get<std::string>(), name);
  }
  if (!case_["tokens"].is_array()) fail("\"tokens\" is no array, expected DWORDs in hex");
  std::vector<std::uint32_t> tokens;
  for (const ordered_json& hex : case_["tokens"]) tokens.push_back(word_of("a token", hex));
  isa::Program program = isa::read_tokens(tokens, name);
  isa::validate(program);
  return program;
}

std::uint32_t ShaderCase::word_of(std::string_view what, const ordered_json& hex) const {
  if (!hex.is_string()) fail(fmt::format("{} is no text, expected 32 bits in hex", what));
  std::uint32_t word = 0;
  const auto& text = hex.get_ref<const std::string&>();
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, word, 16);
  if (text.empty() || stop != end || error != std::errc{})
    fail(fmt::format("{} is {}, expected 32 bits in hex", what, quote_of(text)));
  return word;
}

template <std::size_t words>
std::array<float, words> ShaderCase::vector_of(std::string_view name, const ordered_json& hex) const {
  constexpr std::string_view kNumber = words == 4 ? "four" : "six";
  if (!hex.is_array() || hex.size() != words)
    fail(fmt::format("{0} is no array of {1}, expected {1} words in hex", name, kNumber));
  std::array<float, words> value{};
  for (std::size_t i = 0; i < words; ++i) value[i] = std::bit_cast<float>(word_of(name, hex[i]));
  return value;
}

template <std::size_t words, typename Set>
void ShaderCase::registers(std::string_view group, char letter, int count, Set set) const {
  if (!case_.contains(group)) return;
  if (!case_[group].is_object()) fail(fmt::format("\"{}\" is no object", group));
  for (const auto& [name, value] : case_[group].items()) {
    int index = -1;
    if (name.size() > 1) std::from_chars(name.data() + 1, name.data() + name.size(), index);
    // Each register has one name: "v00" beside "v0" would be a key that stands twice.
    if (index < 0 || index >= count || name != fmt::format("{}{}", letter, index))
      fail(fmt::format("{} has {}, expected {}0 to {}{}", group, quote_of(name), letter, letter, count - 1));
    set(static_cast<std::size_t>(index), vector_of<words>(name, value));
  }
}

std::vector<Vec4> ShaderCase::constants() const {
  std::vector<Vec4> constants(isa::kVertexConstants);
  registers("constants", 'c', isa::kVertexConstants,
            [&](std::size_t i, const Vec4& value) { constants[i] = value; });
  return constants;
}

std::unique_ptr<vertex::InputBatch> ShaderCase::vertex_inputs() const {
  for (const char* key : {"texcoords", "textures", "bump"}) {
    if (case_.contains(key))
      fail(fmt::format("unknown key \"{}\" for a vertex program, expected it with a pixel program alone",
                       key));
  }
  auto in = std::make_unique<vertex::InputBatch>();
  const auto set = [&](std::size_t i, const Vec4& value) {
    for (std::size_t c = 0; c < 4; ++c) std::fill_n(in->v[i][c], vertex::kBatch, value[c]);
  };
  for (std::size_t i = 0; i < isa::kVertexInputs; ++i) set(i, {0, 0, 0, 1});
  registers("inputs", 'v', isa::kVertexInputs, set);
  return in;
}

std::unique_ptr<pixel::FragmentBatch> ShaderCase::fragment() const {
  auto batch = std::make_unique<pixel::FragmentBatch>();
  registers("inputs", 'v', 2, [&](std::size_t i, const Vec4& value) {
    for (std::size_t c = 0; c < 4; ++c) (i == 0 ? batch->v0 : batch->v1)[c][0] = value[c];
  });
  registers("texcoords", 't', pixel::kStages, [&](std::size_t i, const Vec4& value) {
    for (std::size_t c = 0; c < 4; ++c) batch->t[i][c][0] = value[c];
  });
  return batch;
}

pixel::Sampler ShaderCase::textures() const {
  std::array<Vec4, pixel::kStages> texels{};
  registers("textures", 't', pixel::kStages, [&](std::size_t i, const Vec4& value) { texels[i] = value; });
  return [texels](int stage, const pixel::Lanes*, pixel::Lanes* texel, int) {
    for (std::size_t c = 0; c < 4; ++c) texel[c][0] = texels[static_cast<std::size_t>(stage)][c];
  };
}

pixel::BumpStages ShaderCase::bump() const {
  pixel::BumpStages stages{};
  registers<6>("bump", 't', pixel::kStages, [&](std::size_t i, const std::array<float, 6>& value) {
    stages[i] = {{{value[0], value[1]}, {value[2], value[3]}}, value[4], value[5]};
  });
  return stages;
}

}  // namespace splatscope::studies
