#include "traces/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "model/byte_order_mark.h"
#include "model/error.h"
#include "traces/words.h"

namespace splatscope::traces {
namespace {

constexpr std::size_t kMaxLine = 1024;       // characters of a header line
constexpr int kMaxLines = 10000;             // of a header, comments too
constexpr std::size_t kMaxProperties = 256;  // of an element

constexpr std::string_view kEncodings[] = {"ascii", "binary_little_endian", "binary_big_endian"};
// By the values of PlyType.
constexpr std::string_view kTypes[] = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
constexpr std::string_view kAliases[] = {"int8",  "uint8",  "int16",   "uint16",
                                         "int32", "uint32", "float32", "float64"};

std::optional<PlyType> type_named(std::string_view name) {
  for (const auto& names : {kTypes, kAliases})
    for (int type = 0; type < 8; ++type)
      if (names[type] == name) return static_cast<PlyType>(type);
  return std::nullopt;
}

// The header, line by line.
class HeaderReader {
 public:
  HeaderReader(std::istream& in, std::string_view file) : in_(in), file_(file) {}

  PlyHeader read() {
    const std::string first = next_line();
    if (first != "ply" && first != std::string(kByteOrderMark) + "ply")
      fail("the first line is not \"ply\"", "a PLY file");
    bool has_format = false;
    for (;;) {
      const std::string line = next_line();
      const auto words = words_of(line, " \t\r");
      if (words.size() > 2 && words[0] == "comment" && words[1] == "TextureFile")
        header_.texture_comments.push_back(line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "format") {
        if (has_format) fail("a second line \"format\"", "one");
        read_format(words);
        has_format = true;
      } else if (words[0] == "element") {
        read_element(words);
      } else if (words[0] == "property") {
        read_property(words);
      } else if (words[0] == "end_header") {
        break;
      } else {
        fail(fmt::format("unknown word \"{}\"", words[0].substr(0, 40)),
             "format, comment, element, property or end_header");
      }
    }
    if (!has_format) fail("the header has no line \"format\"", "\"format ascii 1.0\" or a binary one");
    header_.lines = line_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(std::string_view what, std::string_view expected) const {
    throw UserError(file_, line_, fmt::format("{}, expected {}", what, expected));
  }

  std::string next_line() {
    ++line_;
    std::string line;
    for (int c; (c = in_.get()) != '\n';) {
      if (c == std::istream::traits_type::eof()) fail("the file ends within the header", "\"end_header\"");
      if (line.size() == kMaxLine || line_ > kMaxLines) fail("the header does not end", "a PLY header");
      line.push_back(static_cast<char>(c));
    }
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
  }

  void read_format(const std::vector<std::string_view>& words) {
    const auto* const found =
        words.size() == 3 ? std::ranges::find(kEncodings, words[1]) : std::end(kEncodings);
    if (found == std::end(kEncodings) || words[2] != "1.0")
      fail("unknown format", "\"format ascii|binary_little_endian|binary_big_endian 1.0\"");
    header_.encoding = static_cast<PlyEncoding>(found - std::begin(kEncodings));
  }

  void read_element(const std::vector<std::string_view>& words) {
    const auto count = words.size() == 3 ? number_of<decltype(PlyElement::count)>(words[2]) : std::nullopt;
    if (!count) fail("wrong element", "\"element NAME COUNT\"");
    PlyElement element;
    element.name = words[1];
    element.count = *count;
    for (const PlyElement& other : header_.elements)
      if (other.name == element.name) fail(fmt::format("element \"{}\" is given twice", element.name), "one");
    header_.elements.push_back(std::move(element));
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property stands before any element", "\"element\" first");
    PlyProperty property;
    property.is_list = words.size() == 5 && words[1] == "list";
    const auto type = words.size() > 2 ? type_named(words[words.size() - 2]) : std::nullopt;
    const auto count_type = property.is_list ? type_named(words[2]) : PlyType::uint8;
    if ((words.size() != 3 && !property.is_list) || !type || !count_type || !is_integer(*count_type))
      fail("wrong property", "\"property TYPE NAME\" or \"property list INTEGER_TYPE TYPE NAME\"");
    property.name = words.back();
    property.type = *type;
    property.count_type = *count_type;
    auto& properties = header_.elements.back().properties;
    for (const PlyProperty& other : properties)
      if (other.name == property.name)
        fail(fmt::format("property \"{}\" is given twice", property.name), "one");
    if (properties.size() == kMaxProperties)
      fail("too many properties", fmt::format("at most {}", kMaxProperties));
    properties.push_back(std::move(property));
  }

  std::istream& in_;
  std::string_view file_;
  int line_ = 0;
  PlyHeader header_;
};

}  // namespace

std::string_view name(PlyEncoding encoding) {
  return kEncodings[static_cast<std::size_t>(encoding)];
}

std::string_view name(PlyType type) {
  return kTypes[static_cast<std::size_t>(type)];
}

PlyHeader read_ply_header(std::istream& in, std::string_view file) {
  return HeaderReader(in, file).read();
}

}  // namespace splatscope::traces
