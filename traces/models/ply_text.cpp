#include "traces/models/ply_text.h"

#include <algorithm>
#include <fstream>
#include <string_view>

#include "model/stop.h"
#include "traces/ply_header.h"
#include "traces/ply_values.h"
#include "traces/words.h"

namespace splatscope::traces {
namespace {

constexpr std::string_view kBlanks = " \t\r";

bool assimp_knows(std::string_view element) {
  constexpr std::string_view kNames[] = {"vertex", "face", "edge", "material"};
  return std::ranges::find(kNames, element) != std::end(kNames);
}

// The lines of `text` in which there is something, without the blanks at their ends.
template <typename Take>
void each_line(std::string_view text, Take take) {
  for (std::size_t at = 0; at < text.size();) {
    stop_if_asked();
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (const std::size_t last = line.find_last_not_of(kBlanks); last != line.npos)
      take(line.substr(0, last + 1));
    at = end + 1;
  }
}

// assimp passes over a line feed that binary data begin with: it belongs to a line that ends by two bytes.
std::string plain_header(std::string_view header, std::string_view line_end) {
  std::string format, lines;
  bool keeps = true;
  each_line(header.substr(std::min(header.find('\n'), header.size())), [&](std::string_view line) {
    const auto words = words_of(line, kBlanks);
    if (words[0] == "element") keeps = assimp_knows(words[1]);
    if (!keeps && (words[0] == "element" || words[0] == "property")) return;
    (words[0] == "format" ? format : lines).append(line).append(line_end);
  });
  return std::string("ply").append(line_end) + format + lines;
}

}  // namespace

std::string ply_text(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::ifstream in(path, std::ios::binary);
  std::string bytes(std::filesystem::file_size(path), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  in.seekg(0);
  const auto offset = [&] {
    return static_cast<std::size_t>(in.rdbuf()->pubseekoff(0, std::ios::cur, std::ios::in));
  };
  const PlyHeader header = read_ply_header(in, file);
  const bool ascii = header.encoding == PlyEncoding::ascii;
  std::size_t begin = offset();
  std::string text = plain_header(std::string_view(bytes).substr(0, begin), ascii ? "\n" : "\r\n");
  text.reserve(text.size() + bytes.size() - begin + 1);
  const auto values = ply_values(in, file, bytes.size(), header);
  for (const PlyElement& element : header.elements) {
    skip_element(*values, element);
    const std::size_t end = offset();
    const std::string_view data = std::string_view(bytes).substr(begin, end - begin);
    begin = end;
    if (!assimp_knows(element.name)) continue;
    if (ascii) {
      each_line(data, [&](std::string_view line) { text.append(line).append("\n"); });
    } else {
      text.append(data);
    }
  }
  values->end();
  return text;
}

}  // namespace splatscope::traces
