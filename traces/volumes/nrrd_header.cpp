#include "traces/volumes/nrrd_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <istream>
#include <map>

#include "model/error.h"
#include "traces/words.h"

namespace splatscope::traces {
namespace {

constexpr std::size_t kMostCharacters = 1024;  // of a line
constexpr int kMostLines = 1000;

struct TypeNames {
  NrrdType type;
  std::size_t bytes;
  std::string_view names;  // between bars
};
constexpr TypeNames kTypes[] = {
    {NrrdType::int8, 1, "|signed char|int8|int8_t|"},
    {NrrdType::uint8, 1, "|uchar|unsigned char|uint8|uint8_t|"},
    {NrrdType::int16, 2, "|short|short int|signed short|signed short int|int16|int16_t|"},
    {NrrdType::uint16, 2, "|ushort|unsigned short|unsigned short int|uint16|uint16_t|"},
    {NrrdType::int32, 4, "|int|signed int|int32|int32_t|"},
    {NrrdType::uint32, 4, "|uint|unsigned int|uint32|uint32_t|"},
    {NrrdType::float32, 4, "|float|"},
    {NrrdType::float64, 8, "|double|"},
};

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

// The header, line by line.
class Reader {
 public:
  Reader(std::istream& in, std::string_view file, int components) : in_(in), file_(file) {
    header_.components = components;
  }

  NrrdHeader read() {
    constexpr std::string_view kMagic = "NRRD000";  // and a digit
    if (!next_line() || !line_.starts_with(kMagic) || line_.size() != kMagic.size() + 1 ||
        line_.back() < '1' || line_.back() > '9')
      fail("the first line is not \"NRRD000N\"", "a NRRD file");
    while (next_line() && !line_.empty()) {
      if (trimmed(line_).empty()) fail("a line of blanks", "an empty line at the end of the header");
      if (line_[0] == '#') continue;
      const std::size_t colon = line_.find(':');
      if (colon == line_.npos) fail("a line without a colon", "\"field: value\"");
      if (line_.substr(colon).starts_with(":=")) continue;  // a key of the writer's own
      const std::string_view field = trimmed(std::string_view(line_).substr(0, colon));
      const std::string name = identifier(field);
      const auto [place, is_new] = lines_.emplace(name, number_);
      if (!is_new)
        fail(fmt::format("\"{}\" for the second time", shown(field)),
             fmt::format("it once, as in line {}", place->second));
      read_field(name, trimmed(std::string_view(line_).substr(colon + 1)));
    }
    finish();
    return header_;
  }

 private:
  [[noreturn]] void fail(std::string_view what, std::string_view expected) const {
    throw UserError(file_, number_, fmt::format("{}, expected {}", what, expected));
  }
  static std::string in_small_letters(std::string_view text) {
    std::string small(text);
    std::ranges::transform(small, small.begin(), [](unsigned char c) { return std::tolower(c); });
    return small;
  }
  // Fields are written in small letters or large, some with a blank or without.
  static std::string identifier(std::string_view field) {
    std::string name = in_small_letters(field);
    std::erase(name, ' ');
    return name;
  }
  static std::string shown(std::string_view text) {
    std::string copy(text.substr(0, 40));
    for (char& c : copy) {
      if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
    }
    return copy;
  }

  bool next_line() {
    line_.clear();
    if (++number_ > kMostLines)
      fail(fmt::format("more than {} lines of header", kMostLines), "an empty line at its end");
    for (int c; (c = in_.get()) != std::istream::traits_type::eof();) {
      ++header_.data_start;
      if (c == '\n') {
        if (line_.ends_with('\r')) line_.pop_back();
        return true;
      }
      if (line_.size() == kMostCharacters) {
        fail(fmt::format("a line of more than {} characters", kMostCharacters), "a NRRD header");
      }
      line_ += static_cast<char>(c);
    }
    return !line_.empty();
  }

  void read_field(std::string_view name, std::string_view value) {
    if (name == "type") {
      read_type(value);
    } else if (name == "dimension") {
      const std::string_view expected = header_.components > 1 ? "4" : "3";
      if (value != expected) fail(fmt::format("dimension is \"{}\"", shown(value)), expected);
    } else if (name == "sizes") {
      read_sizes(value);
    } else if (header_.components > 1 && (name == "spacings" || name == "spacedirections")) {
      return;
    } else if (name == "spacings") {
      read_spacings(value);
    } else if (name == "spacedirections") {
      read_directions(value);
    } else if (name == "encoding") {
      if (in_small_letters(value) != "raw")
        fail(fmt::format("encoding is \"{}\"", shown(value)), "raw (unu save -e raw converts)");
    } else if (name == "endian") {
      const std::string order = in_small_letters(value);
      if (order != "big" && order != "little")
        fail(fmt::format("endian is \"{}\"", shown(value)), "big or little");
      header_.big_endian = order == "big";
    } else if (name == "datafile") {
      if (value.empty() || value.starts_with("LIST") || value.find('%') != value.npos) {
        fail(fmt::format("data file is \"{}\"", shown(value)), "the name of one file");
      }
      header_.data_file = std::string(value);
    } else if (name == "byteskip") {
      const auto skip = number_of<std::uint32_t>(value);
      if (!skip)
        fail(fmt::format("byte skip is \"{}\"", shown(value)), "a whole number from 0 to 4294967295");
      header_.skip = *skip;
    } else if (name == "lineskip") {
      if (value != "0") fail(fmt::format("line skip is \"{}\"", shown(value)), "0");
    }
  }

  void read_type(std::string_view value) {
    for (const TypeNames& type : kTypes) {
      if (value.find('|') == value.npos &&
          type.names.find(fmt::format("|{}|", in_small_letters(value))) != type.names.npos) {
        header_.type = type.type;
        return;
      }
    }
    fail(fmt::format("type is \"{}\"", shown(value)),
         "int8, uint8, int16, uint16, int32, uint32, float or double");
  }

  void read_sizes(std::string_view value) {
    auto words = words_of(value, " \t");
    if (header_.components > 1) {
      if (words.size() != 4 || words[0] != "3")
        fail(fmt::format("sizes are \"{}\"", shown(value)), "3 and three more");
      words.erase(words.begin());
    }
    if (words.size() != 3) fail(fmt::format("{} sizes", words.size()), "three");
    for (int axis = 0; axis < 3; ++axis) {
      const auto size = number_of<int>(words[static_cast<std::size_t>(axis)]);
      if (!size || *size < 1 || *size > NrrdHeader::kMostAlong) {
        fail(fmt::format("a size of \"{}\"", shown(words[static_cast<std::size_t>(axis)])),
             fmt::format("a whole number from 1 to {}", NrrdHeader::kMostAlong));
      }
      header_.size[axis] = *size;
    }
    if (header_.voxels() > NrrdHeader::kMostVoxels) {
      fail(fmt::format("{} voxels", header_.voxels()), fmt::format("at most {}", NrrdHeader::kMostVoxels));
    }
  }

  double spacing(std::string_view word) const {
    const auto value = number_of<double>(word);
    if (!value || !(*value >= 1e-9 && *value <= 1e9)) {
      fail(fmt::format("a spacing of \"{}\"", shown(word)), "a number from 1e-9 to 1e9");
    }
    return *value;
  }

  void read_spacings(std::string_view value) {
    const auto words = words_of(value, " \t");
    if (words.size() != 3) fail(fmt::format("{} spacings", words.size()), "three");
    for (int axis = 0; axis < 3; ++axis)
      header_.spacing[axis] = spacing(words[static_cast<std::size_t>(axis)]);
  }

  // "(1,0,0) (0,1,0) (0,0,2)": their lengths; how the volume lies in the world is not kept.
  void read_directions(std::string_view value) {
    const auto words = words_of(value, " \t,()");
    if (words.size() != 9)
      fail(fmt::format("{} numbers in space directions", words.size()), "three vectors of three");
    glm::dmat3 directions;
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < 3; ++i) {
        const std::string_view word = words[static_cast<std::size_t>(3 * axis + i)];
        const auto entry = number_of<double>(word);
        if (!entry || !(std::abs(*entry) <= 1e9))
          fail(fmt::format("\"{}\" in space directions", shown(word)), "a number");
        directions[axis][i] = *entry;
      }
      header_.spacing[axis] = glm::length(directions[axis]);
      if (!(header_.spacing[axis] >= 1e-9))
        fail("a space direction of length 0", "a length from 1e-9 to 1e9");
    }
    constexpr double kLeastSkew = 1e-3;  // as a cosine: what files round their directions to is less
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3;
      const double cosine =
          glm::dot(directions[axis], directions[next]) / (header_.spacing[axis] * header_.spacing[next]);
      if (!(std::abs(cosine) < kLeastSkew)) fail("skewed space directions", "axes at right angles");
    }
  }

  void finish() const {
    if (lines_.contains("spacings") && lines_.contains("spacedirections"))
      fail("spacings beside space directions", "one of them");
    const bool placed = lines_.contains("axismins") || lines_.contains("axismaxs");
    if (header_.components == 1 && placed && !lines_.contains("spacings") &&
        !lines_.contains("spacedirections"))
      fail("axis mins or maxs without spacings", "spacings");
    for (const char* name : {"type", "dimension", "sizes", "encoding"}) {
      if (!lines_.contains(name)) fail(fmt::format("the header ends without \"{}\"", name), "that field");
    }
    const bool wide = bytes_of(header_.type) > 1;
    if (wide && !lines_.contains("endian"))
      fail("the header ends without \"endian\"", "big or little for this type");
  }

  std::istream& in_;
  std::string_view file_;
  std::string line_;
  int number_ = 0;
  std::map<std::string, int> lines_;  // of each field
  NrrdHeader header_;
};

}  // namespace

std::size_t bytes_of(NrrdType type) {
  return std::ranges::find(kTypes, type, &TypeNames::type)->bytes;
}

NrrdHeader read_nrrd_header(std::istream& in, std::string_view file, int components) {
  return Reader(in, file, components).read();
}

}  // namespace splatscope::traces
