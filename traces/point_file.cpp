#include "traces/point_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

#include "model/error.h"
#include "model/stop.h"
#include "traces/output_files.h"
#include "traces/ply_header.h"

namespace splatscope::traces {
namespace {

// The values after the header, one at a time. In ASCII those of each vertex, or other thing, are a line.
class PlyValues {
 public:
  virtual ~PlyValues() = default;
  virtual void begin_row(const PlyElement&) {}
  virtual double next(PlyType type) = 0;
  virtual void end_row() {}
  // Says where the reader is and throws.
  [[noreturn]] virtual void fail(std::string_view what, std::string_view expected) const = 0;
};

class AsciiValues : public PlyValues {
 public:
  AsciiValues(std::istream& in, std::string_view file, int line)
      : in_(*in.rdbuf()), file_(file), line_(line + 1) {}

  // Lines without a word are passed over.
  void begin_row(const PlyElement& element) override {
    element_ = &element;
    read_ = 0;
    if (!skip_blank_lines()) fail("the file ends within its data", "a number");
  }

  // The type is not enforced: an ASCII file's numbers are what they are.
  double next(PlyType) override {
    const std::string_view word = next_word();
    const std::string_view digits = word.front() == '+' ? word.substr(1) : word;
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size())
      fail(fmt::format("\"{}\" is no number", word), "a number");
    ++read_;
    return value;
  }

  void end_row() override {
    const std::size_t expected = read_;
    for (; !at_line_end(); ++read_)
      for (int c = in_.sgetc(); c != kEnd && !is_space(c) && c != '\n'; c = in_.snextc()) stop_if_asked();
    if (read_ != expected) fail(numbers(read_), fmt::format("{}", expected));
  }

  // Nothing but blank lines may follow.
  void end() {
    if (skip_blank_lines()) fail("a line more than the header counts", "the end of the file");
  }

  [[noreturn]] void fail(std::string_view what, std::string_view expected) const override {
    throw UserError(file_, line_, fmt::format("{}, expected {}", what, expected));
  }

 private:
  static constexpr int kEnd = std::char_traits<char>::eof();

  static bool is_space(int c) { return c == ' ' || c == '\t' || c == '\r'; }

  static std::string numbers(std::size_t count) {
    return fmt::format("{} number{}", count, count == 1 ? "" : "s");
  }

  bool at_line_end() {
    int c = in_.sgetc();
    while (is_space(c)) c = in_.snextc();
    return c == '\n' || c == kEnd;
  }

  // False at the end of the file.
  bool skip_blank_lines() {
    while (at_line_end()) {
      stop_if_asked();
      if (in_.sbumpc() == kEnd) return false;
      ++line_;
    }
    return true;
  }

  std::string_view next_word() {
    if (at_line_end()) {
      const bool has_list = std::ranges::any_of(element_->properties, &PlyProperty::is_list);
      fail(numbers(read_), has_list ? "more" : fmt::format("{}", element_->properties.size()));
    }
    std::size_t size = 0;
    for (int c = in_.sgetc(); c != kEnd && c != '\n' && !is_space(c); c = in_.snextc()) {
      if (size == sizeof word_) fail("a word does not end", "a number");
      word_[size++] = static_cast<char>(c);
    }
    return {word_, size};
  }

  std::streambuf& in_;
  std::string_view file_;
  int line_;
  const PlyElement* element_ = nullptr;  // of the row
  std::size_t read_ = 0;                 // numbers of the row
  char word_[64];
};

template <class Value>
double decode(const unsigned char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

class BinaryValues : public PlyValues {
 public:
  BinaryValues(std::istream& in, std::string_view file, bool big_endian)
      : in_(*in.rdbuf()),
        file_(file),
        offset_(in.tellg()),
        swap_(big_endian != (std::endian::native == std::endian::big)) {}

  double next(PlyType type) override {
    unsigned char bytes[8];
    const auto size = static_cast<std::streamsize>(size_in_bytes(type));
    if (in_.sgetn(reinterpret_cast<char*>(bytes), size) != size)
      fail("the file ends within its data", fmt::format("a value of {} bytes", size));
    offset_ += size;
    if (swap_) std::reverse(bytes, bytes + size);
    switch (type) {
      case PlyType::int8:
        return decode<std::int8_t>(bytes);
      case PlyType::uint8:
        return decode<std::uint8_t>(bytes);
      case PlyType::int16:
        return decode<std::int16_t>(bytes);
      case PlyType::uint16:
        return decode<std::uint16_t>(bytes);
      case PlyType::int32:
        return decode<std::int32_t>(bytes);
      case PlyType::uint32:
        return decode<std::uint32_t>(bytes);
      case PlyType::float32:
        return decode<float>(bytes);
      case PlyType::float64:
        return decode<double>(bytes);
    }
    throw ModelError("BinaryValues: no such type");
  }

  [[noreturn]] void fail(std::string_view what, std::string_view expected) const override {
    throw UserError(file_, 0, fmt::format("{} at byte {}, expected {}", what, offset_, expected));
  }

 private:
  std::streambuf& in_;
  std::string_view file_;
  std::streamoff offset_;
  bool swap_;
};

// Where a property's value goes; nullptr: passed over.
float* place(Surfel& s, float& value, std::string_view name) {
  struct Named {
    std::string_view name;
    float* place;
  };
  const Named places[] = {{"x", &s.position.x},  {"y", &s.position.y}, {"z", &s.position.z},
                          {"nx", &s.normal.x},   {"ny", &s.normal.y},  {"nz", &s.normal.z},
                          {"radius", &s.radius}, {"red", &s.color.r},  {"green", &s.color.g},
                          {"blue", &s.color.b},  {"value", &value}};
  for (const Named& p : places)
    if (p.name == name) return p.place;
  return nullptr;
}

double full_scale(const PlyProperty& property) {
  const bool is_color = property.name == "red" || property.name == "green" || property.name == "blue";
  if (!is_color || !is_integer(property.type)) return 1;
  return property.type == PlyType::uint16 ? 65535 : 255;
}

void skip_list(PlyValues& values, const PlyProperty& property) {
  const double count = values.next(property.count_type);
  if (!(count >= 0 && count <= 4294967295.0))
    values.fail(fmt::format("a list of {} items", count), "0 or more");
  for (auto left = static_cast<std::uint64_t>(count); left > 0; --left) {
    stop_if_asked();
    values.next(property.type);
  }
}

void skip_element(PlyValues& values, const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    values.begin_row(element);
    for (const PlyProperty& property : element.properties)
      property.is_list ? skip_list(values, property) : static_cast<void>(values.next(property.type));
    values.end_row();
  }
}

// One pass over the properties of a surfel, decided once for all of them.
struct Column {
  const PlyProperty* property;
  float* place;  // in the surfel that is being read, or nullptr
  double scale;
};

void read_surfels(PlyValues& values, const PlyElement& element, bool has_values, PointFile& points) {
  points.surfels.reserve(element.count);
  if (has_values) points.values.reserve(element.count);
  Surfel surfel;
  float value = 0;
  surfel.color = {1, 1, 1};
  std::vector<Column> columns;
  for (const PlyProperty& property : element.properties)
    columns.push_back({&property, property.is_list ? nullptr : place(surfel, value, property.name),
                       1 / full_scale(property)});
  for (std::uint64_t i = 0; i < element.count; ++i) {
    stop_if_asked();
    values.begin_row(element);
    for (const Column& column : columns) {
      if (column.property->is_list) {
        skip_list(values, *column.property);
      } else {
        const double number = values.next(column.property->type);
        if (column.place) *column.place = static_cast<float>(number * column.scale);
      }
    }
    values.end_row();
    points.surfels.push_back(surfel);
    if (has_values) points.values.push_back(value);
  }
}

// All of a group of properties, or none: true or false.
bool has_group(const PlyElement& element, std::initializer_list<std::string_view> names,
               std::string_view file) {
  std::string missing;
  for (std::string_view name : names) {
    const bool found = std::any_of(element.properties.begin(), element.properties.end(),
                                   [&](const PlyProperty& p) { return p.name == name && !p.is_list; });
    if (!found) missing += fmt::format("{}{}", missing.empty() ? "" : ", ", name);
  }
  const bool none = std::count(missing.begin(), missing.end(), ',') + 1 == static_cast<int>(names.size());
  if (missing.empty()) return true;
  if (none && *names.begin() != "x") return false;
  throw UserError(file, 0,
                  fmt::format("property {} of element vertex is missing, expected {}", missing,
                              *names.begin() == "x" ? "x, y and z" : "all of its group or none"));
}

// A count that the file cannot hold is refused before memory is taken for it.
void check_size(const PlyHeader& header, const PlyElement& vertex, std::uintmax_t file_size,
                std::string_view file) {
  std::uint64_t least = 0;  // bytes of a surfel; in ASCII a digit and a space a value
  for (const PlyProperty& p : vertex.properties)
    least += header.encoding == PlyEncoding::ascii ? 2 : size_in_bytes(p.is_list ? p.count_type : p.type);
  if (vertex.count > (file_size + 1) / std::max<std::uint64_t>(least, 1))
    throw UserError(file, 0,
                    fmt::format("{} {} do not fit in its {} bytes, expected a whole file", vertex.count,
                                vertex.name == "vertex" ? "vertices" : vertex.name + " elements", file_size));
}

std::ifstream open(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::error_code error;
  if (!in || std::filesystem::is_directory(path, error))
    throw UserError(path.string(), 0, "cannot be read, expected a PLY file");
  return in;
}

// A surfel in a file of write_ply.
struct WrittenSurfel {
  float values[7];  // position, normal, radius
  std::uint8_t color[3];
};
constexpr std::size_t kWrittenBytes = 31;  // without the padding at its end

}  // namespace

bool ply_has_faces(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::ifstream in = open(path);
  const PlyHeader header = read_ply_header(in, file);
  bool faces = false;
  for (const PlyElement& element : header.elements) {
    check_size(header, element, std::filesystem::file_size(path), file);
    faces |= element.name == "face" && element.count > 0;
  }
  return faces;
}

void write_ply(std::span<const Surfel> surfels, const std::filesystem::path& path) {
  static_assert(std::endian::native == std::endian::little && sizeof(float) == 4);
  std::string bytes =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", surfels.size());
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "radius"})
    bytes += fmt::format("property float {}\n", name);
  for (const char* name : {"red", "green", "blue"}) bytes += fmt::format("property uchar {}\n", name);
  bytes += "end_header\n";
  bytes.reserve(bytes.size() + kWrittenBytes * surfels.size());
  for (const Surfel& s : surfels) {
    WrittenSurfel out{
        {s.position.x, s.position.y, s.position.z, s.normal.x, s.normal.y, s.normal.z, s.radius}, {}};
    for (int i = 0; i < 3; ++i)
      out.color[i] = static_cast<std::uint8_t>(std::lround(std::clamp(s.color[i], 0.0f, 1.0f) * 255.0f));
    bytes.append(reinterpret_cast<const char*>(&out), kWrittenBytes);
  }
  write_file(path, bytes);
}

PointFile read_ply(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::ifstream in = open(path);
  const auto file_size = std::filesystem::file_size(path);
  const PlyHeader header = read_ply_header(in, file);
  const auto vertex = std::find_if(header.elements.begin(), header.elements.end(),
                                   [](const PlyElement& e) { return e.name == "vertex"; });
  if (vertex == header.elements.end())
    throw UserError(file, header.lines, "the header has no element vertex, expected one");
  PointFile points;
  has_group(*vertex, {"x", "y", "z"}, file);
  points.has_normals = has_group(*vertex, {"nx", "ny", "nz"}, file);
  points.has_radii = has_group(*vertex, {"radius"}, file);
  has_group(*vertex, {"red", "green", "blue"}, file);
  check_size(header, *vertex, file_size, file);
  if (vertex->count > kMostSurfels)
    throw UserError(file, 0, fmt::format("{} vertices, expected at most {}", vertex->count, kMostSurfels));
  const bool has_values = has_group(*vertex, {"value"}, file);
  const auto read_to_vertices = [&](PlyValues& values) {
    for (auto element = header.elements.begin(); element != vertex; ++element) skip_element(values, *element);
    read_surfels(values, *vertex, has_values, points);
  };
  if (header.encoding != PlyEncoding::ascii) {
    BinaryValues values(in, file, header.encoding == PlyEncoding::binary_big_endian);
    read_to_vertices(values);
    return points;
  }
  AsciiValues values(in, file, header.lines);
  read_to_vertices(values);
  for (auto element = vertex + 1; element != header.elements.end(); ++element) skip_element(values, *element);
  values.end();
  return points;
}

}  // namespace splatscope::traces
