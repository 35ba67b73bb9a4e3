#include "traces/point_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>

#include "model/error.h"
#include "model/stop.h"
#include "traces/output_files.h"
#include "traces/ply_header.h"
#include "traces/ply_values.h"

namespace splatscope::traces {
namespace {

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

// assimp scales colours of other types by what is not their range, and takes what is missing of a group for
// zeros.
void check_mesh_vertex(const PlyHeader& header, const std::string& file) {
  constexpr std::string_view kColors[] = {"red", "green", "blue", "r", "g", "b"};  // of assimp's
  constexpr PlyType kTypes[] = {PlyType::uint8, PlyType::uint16, PlyType::float32, PlyType::float64};
  const auto vertex = std::ranges::find(header.elements, "vertex", &PlyElement::name);
  if (vertex == header.elements.end()) return;
  has_group(*vertex, {"x", "y", "z"}, file);
  has_group(*vertex, {"nx", "ny", "nz"}, file);
  has_group(*vertex, {"red", "green", "blue"}, file);
  has_group(*vertex, {"r", "g", "b"}, file);
  for (const PlyProperty& property : vertex->properties)
    if (std::ranges::find(kColors, property.name) != std::end(kColors) &&
        std::ranges::find(kTypes, property.type) == std::end(kTypes))
      throw UserError(file, 0,
                      fmt::format("the type of \"{}\" is none that colours of a mesh are read in, expected "
                                  "uchar, ushort, float or double",
                                  property.name));
}

std::ifstream open(const std::filesystem::path& path) {
  std::error_code error;
  std::ifstream in;
  if (std::filesystem::is_regular_file(path, error)) in.open(path, std::ios::binary);
  if (!in.is_open()) throw UserError(path.string(), 0, "cannot be read, expected a PLY file");
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
    if (element.name == "tristrips" && element.count > 0)  // assimp makes other triangles of them
      throw UserError(file, 0, "holds triangle strips, expected a mesh of faces, or points alone");
    faces |= element.name == "face" && element.count > 0;
  }
  if (faces) check_mesh_vertex(header, file);
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
  const auto values = ply_values(in, file, file_size, header);
  for (const PlyElement& element : header.elements) {
    if (&element == &*vertex)
      read_surfels(*values, element, has_values, points);
    else
      skip_element(*values, element);
  }
  values->end();
  return points;
}

}  // namespace splatscope::traces
