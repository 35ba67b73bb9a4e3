#include "traces/models/ply_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

#include "model/input_file.h"
#include "model/stop.h"
#include "traces/ply_header.h"
#include "traces/ply_values.h"

namespace splatscope::traces {
namespace {

struct Part {
  const PlyElement* element;
  std::string_view data;
};

// It takes as many lines for an element without properties as that counts, and we take none.
bool assimp_knows(const PlyElement& element) {
  constexpr std::string_view kNames[] = {"vertex", "face", "edge", "material"};
  return std::ranges::find(kNames, element.name) != std::end(kNames) && !element.properties.empty();
}

// assimp passes over a line feed that binary data begin with: it belongs to a line that ends by two bytes.
std::string text_of(const PlyHeader& header, const std::vector<Part>& parts) {
  const std::string_view end = header.encoding == PlyEncoding::ascii ? "\n" : "\r\n";
  std::string text = fmt::format("ply{1}format {0} 1.0{1}", name(header.encoding), end);
  for (const std::string& comment : header.texture_comments) text.append(comment).append(end);
  for (const Part& part : parts) {
    text += fmt::format("element {} {}{}", part.element->name, part.element->count, end);
    for (const PlyProperty& p : part.element->properties)
      text += p.is_list
                  ? fmt::format("property list {} {} {}{}", name(p.count_type), name(p.type), p.name, end)
                  : fmt::format("property {} {}{}", name(p.type), p.name, end);
  }
  return text.append("end_header").append(end);
}

// The lines in which there is something. A carriage return within one is a blank, as in ply_values.
void append_rows(std::string_view data, std::string& text) {
  for (std::size_t at = 0; at < data.size();) {
    stop_if_asked();
    const std::size_t end = std::min(data.find('\n', at), data.size());
    const std::string_view line = data.substr(at, end - at);
    at = end + 1;
    const std::size_t last = line.find_last_not_of(" \t\r");
    if (last == line.npos) continue;
    const auto row = static_cast<std::ptrdiff_t>(text.size());
    text.append(line.substr(0, last + 1));
    std::replace(text.begin() + row, text.end(), '\r', ' ');
    text.push_back('\n');
  }
}

}  // namespace

std::string ply_text(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::istringstream in(file_bytes(path), std::ios::binary);
  const PlyHeader header = read_ply_header(in, file);
  const auto values = ply_values(in, file, in.view().size(), header, PlyTypes::enforced);
  const auto offset = [&] {
    return static_cast<std::size_t>(in.rdbuf()->pubseekoff(0, std::ios::cur, std::ios::in));
  };
  std::vector<Part> parts;
  for (const PlyElement& element : header.elements) {
    const std::size_t begin = offset();
    skip_element(*values, element);
    if (assimp_knows(element)) parts.push_back({&element, in.view().substr(begin, offset() - begin)});
  }
  values->end();
  std::ranges::stable_partition(parts, [](const Part& part) { return part.element->name == "vertex"; });
  std::string text = text_of(header, parts);
  text.reserve(text.size() + in.view().size());
  for (const Part& part : parts)
    header.encoding == PlyEncoding::ascii ? append_rows(part.data, text) : void(text.append(part.data));
  return text;
}

}  // namespace splatscope::traces
