#include "traces/scene_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <utility>

#include "model/error.h"
#include "model/input_file.h"

namespace splatscope::traces {
namespace {

// What surfels are made from.
constexpr unsigned kFromPlane = 1, kFromModel = 2, kFromPoints = 4;

// Stores the value of one key; false where its type or range is wrong.
struct Store {
  SceneSettings& settings;
  const toml::node& node;
  const toml::node* looked_at = &node;          // an entry of `node`, or all of it
  std::optional<std::size_t> entry_index = {};  // of an entry

  bool operator()(const RealValue& v) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !(*value >= v.min && *value <= v.max)) return false;
    v.place(settings) = *value;
    return true;
  }
  bool operator()(const IntegerValue& v) const {
    const auto value = node.value_exact<std::int64_t>();
    if (!value || *value < v.min || *value > v.max) return false;
    v.place(settings) = static_cast<int>(*value);
    return true;
  }
  bool operator()(const BooleanValue& v) const {
    const auto value = node.value_exact<bool>();
    if (value) v.place(settings) = *value;
    return value.has_value();
  }
  bool operator()(const TextValue& v) const {
    const auto value = node.value_exact<std::string>();
    if (!value || value->find('\0') != std::string::npos) return false;  // which no name of a file holds
    v.place(settings) = *value;
    return true;
  }
  bool operator()(const ChoiceValue& v) const {
    const auto value = node.value_exact<std::string>();
    const auto found = value ? std::find(v.names.begin(), v.names.end(), *value) : v.names.end();
    if (found == v.names.end()) return false;
    v.store(settings, static_cast<int>(found - v.names.begin()));
    return true;
  }
  bool operator()(const TransferValue& v) {
    const toml::array* points = node.as_array();
    if (!points) return false;
    std::vector<kernels::TransferPoint>& place = v.place(settings);
    for (const toml::node& entry : *points) {
      look_at(entry, place.size());
      const toml::table* point = entry.as_table();
      if (!point || point->size() != 3) return false;
      place.emplace_back();
      if (!number(*point, "value", -1e30, 1e30, place.back().value) ||
          !number(*point, "opacity", 0, 1, place.back().look.opacity) ||
          !numbers(point->get("color"), 0, 1, place.back().look.color) ||
          !std::ranges::is_sorted(std::span(place).last(std::min<std::size_t>(2, place.size())), {},
                                  &kernels::TransferPoint::value)) {
        return false;
      }
    }
    return true;
  }
  bool operator()(const PlacesValue& v) {
    const toml::array* places = node.as_array();
    if (!places) return false;
    std::vector<double>& out = v.place(settings);
    for (const toml::node& entry : *places) {
      look_at(entry, out.size());
      const auto value = entry.is_number() ? entry.value<double>() : std::nullopt;
      if (!value || !(*value >= v.min && *value <= v.max)) return false;
      if (!out.empty() && !(*value > out.back())) return false;
      out.push_back(*value);
    }
    return true;
  }
  bool operator()(const VectorValue& v) const { return numbers(&node, v.min, v.max, v.place(settings)); }

 private:
  void look_at(const toml::node& entry, std::size_t index) {
    looked_at = &entry;
    entry_index = index;
  }
  static bool number(const toml::table& table, std::string_view name, double min, double max, double& out) {
    const toml::node* found = table.get(name);
    const auto value = found && found->is_number() ? found->value<double>() : std::nullopt;
    if (!value || !(*value >= min && *value <= max)) return false;
    out = *value;
    return true;
  }
  static bool numbers(const toml::node* node, double min, double max, glm::dvec3& out) {
    const toml::array* numbers = node ? node->as_array() : nullptr;
    if (!numbers || numbers->size() != 3) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const toml::node& number = *numbers->get(i);
      const auto value = number.is_number() ? number.value<double>() : std::nullopt;
      if (!value || !(*value >= min && *value <= max)) return false;
      out[static_cast<glm::length_t>(i)] = *value;
    }
    return true;
  }
};

// The value as it stands in the file, cut to a length that an error message can bear.
std::string shown(const toml::node& node) {
  std::ostringstream out;
  out << toml::node_view<const toml::node>(&node);
  std::string text = out.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

int line(const toml::node& node) {
  return static_cast<int>(node.source().begin.line);
}
int line(const toml::key& key) {
  return static_cast<int>(key.source().begin.line);
}

std::string names_of(std::string_view table) {
  std::string names;
  for (const SceneKey& key : scene_keys()) {
    const std::string_view name = table.empty() ? key.table : key.name;
    const bool listed = !table.empty() ? key.table != table : names.find(name) != std::string::npos;
    if (!listed) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  }
  return names;
}

const SceneKey* find_key(std::string_view table, std::string_view name) {
  const auto keys = scene_keys();
  const auto found = std::find_if(
      keys.begin(), keys.end(), [&](const SceneKey& key) { return key.table == table && key.name == name; });
  return found == keys.end() ? nullptr : &*found;
}

bool is_table(std::string_view name) {
  const auto keys = scene_keys();
  return std::any_of(keys.begin(), keys.end(), [&](const SceneKey& key) { return key.table == name; });
}

void read_table(SceneSettings& settings, std::string_view name, const toml::table& table,
                std::string_view file) {
  for (const auto& [key, node] : table) {
    const SceneKey* declared = find_key(name, key.str());
    if (!declared)
      throw UserError(
          file, line(key),
          fmt::format("unknown key \"{}\" in [{}], expected one of: {}", key.str(), name, names_of(name)));
    Store store{settings, node};
    if (!std::visit(store, declared->value))
      throw UserError(file, line(*store.looked_at),
                      fmt::format("{}.{}{} is {}, expected {}", name, key.str(),
                                  store.entry_index ? fmt::format("[{}]", *store.entry_index) : "",
                                  shown(*store.looked_at),
                                  store.entry_index ? entry_expectation(*declared) : expectation(*declared)));
    settings.lines.emplace(fmt::format("{}.{}", name, key.str()), line(key));
  }
}

CameraKeys keys_given(const SceneSettings& settings) {
  return {.eye = settings.gives("camera.eye"),
          .target = settings.gives("camera.target"),
          .up = settings.gives("camera.up"),
          .fov_y_degrees = settings.gives("camera.fov_y_degrees"),
          .near = settings.gives("camera.near"),
          .far = settings.gives("camera.far")};
}

void check_capture(const SceneSettings& settings, std::string_view file) {
  if (!glm::all(glm::lessThanEqual(settings.capture.box_min, settings.capture.box_max)))
    throw UserError(file, settings.line_of({"capture.box_min", "capture.box_max"}),
                    "capture.box_min exceeds capture.box_max, expected min <= max in x, y and z");
}

std::string_view it_or_them(const std::vector<std::string_view>& keys) {
  return keys.size() > 1 ? "them" : "it";
}

// Keys that the plane, a mesh or a model, or points have no use for. A key at its default asks for nothing.
// `sources`: what the surfels may come from; a file's kind is known only when it is looked at.
void check_source(const SceneSettings& settings, std::string_view file, unsigned sources) {
  const SurfelSource &asked = settings.surfels, usual = default_settings().surfels;
  struct Use {
    unsigned sources;
    std::string_view without, expected;
  };
  constexpr Use kPlane{kFromPlane, "the plane", "generator = \"plane\" and no file"},
      kSampled{kFromModel, "a mesh or a model", "a file with faces or another generator than the plane"},
      kMade{kFromModel | kFromPoints, "a file or a model", "a file or another generator than the plane"};
  const std::tuple<std::string_view, const Use&, bool> keys[] = {
      {"surfels.columns", kPlane, asked.columns != usual.columns},
      {"surfels.rows", kPlane, asked.rows != usual.rows},
      {"surfels.checker_square", kPlane, asked.checker_square != usual.checker_square},
      {"surfels.checker_light", kPlane, asked.checker_light != usual.checker_light},
      {"surfels.checker_dark", kPlane, asked.checker_dark != usual.checker_dark},
      {"surfels.count", kSampled, asked.count != usual.count},
      {"surfels.pattern", kSampled, asked.pattern != usual.pattern},
      {"surfels.pattern_scale", kSampled, asked.pattern_scale != usual.pattern_scale},
      {"surfels.shading", kSampled, asked.shading != usual.shading},
      {"surfels.mirror", kMade, asked.mirror != usual.mirror},
      {"surfels.neighbours", kMade, asked.neighbours != usual.neighbours}};
  for (const Use* use : {&kPlane, &kSampled, &kMade}) {
    if ((use->sources & sources) != 0) continue;
    std::vector<std::string_view> useless;
    for (const auto& [key, of, changed] : keys)
      if (changed && &of == use) useless.push_back(key);
    if (useless.empty()) continue;
    throw UserError(file, settings.line_of({useless[0]}),
                    fmt::format("{} without {}, expected {} removed, or surfels with {}",
                                fmt::join(useless, ", "), use->without, it_or_them(useless), use->expected));
  }
}

// What can be told of the surfels without looking at their file.
void check_surfels(const SceneSettings& settings, std::string_view file) {
  const SurfelSource& asked = settings.surfels;
  if (!asked.file.empty() && asked.generator != default_settings().surfels.generator)
    throw UserError(file, settings.line_of({"surfels.generator"}),
                    "surfels.generator beside surfels.file, expected one of them");
  const unsigned by_generator = is_plane(asked) ? kFromPlane : kFromModel;
  check_source(settings, file, asked.file.empty() ? by_generator : kFromModel | kFromPoints);
  if (asked.pattern_scale != default_settings().surfels.pattern_scale && !has_scale(asked.pattern))
    throw UserError(
        file, settings.line_of({"surfels.pattern_scale"}),
        "surfels.pattern_scale without squares, stripes or spots, expected it removed, or another "
        "surfels.pattern");
}

// What would have nothing to act on. A key at its default asks for nothing.
void check_hierarchy(const SceneSettings& settings, std::string_view file) {
  const Hierarchy &asked = settings.hierarchy, usual = default_settings().hierarchy;
  const bool none =
      asked.culling == Culling::none || (asked.culling == Culling::automatic && is_plane(settings.surfels));
  const bool dense = asked.surfels_per_pixel != usual.surfels_per_pixel;
  const std::pair<std::string_view, bool> keys[] = {
      {"hierarchy.block_surfels", asked.block_surfels != usual.block_surfels},
      {"hierarchy.level", asked.levels},
      {"hierarchy.surfels_per_pixel", dense},
      {"hierarchy.progressive", asked.progressive}};
  std::vector<std::string_view> changed_keys;
  for (const auto& [key, changed] : keys)
    if (changed) changed_keys.push_back(key);
  if (none && !changed_keys.empty()) {
    throw UserError(
        file, settings.line_of({changed_keys[0]}),
        fmt::format("{} without a hierarchy, expected {} removed, or hierarchy.culling = \"off\" (every "
                    "block) or \"blocks\"{}",
                    fmt::join(changed_keys, ", "), it_or_them(changed_keys),
                    asked.culling == Culling::none ? "" : ", as the plane has none by default"));
  }
  if (dense && !asked.levels)
    throw UserError(file, settings.line_of({"hierarchy.surfels_per_pixel"}),
                    "hierarchy.surfels_per_pixel with level \"finest\", expected level = \"auto\"");
}

void check_refine(const SceneSettings& settings, std::string_view file) {
  const Splatting& splatting = settings.splatting;
  if (splatting.refine && splatting.algorithm != Algorithm::ewa_per_surfel)
    throw UserError(file, settings.line_of({"splatting.refine"}),
                    fmt::format("splatting.refine with algorithm \"{}\", expected \"ewa-per-surfel\"",
                                name(splatting.algorithm)));
}

std::string text_of(const glm::dvec3& v) {
  return fmt::format("[{:g}, {:g}, {:g}]", v.x, v.y, v.z);
}

// near >= far. Where a scene leaves a plane open it is put where what is to be seen begins or ends, with
// room.
[[noreturn]] void refuse_planes(const SceneSettings& settings, std::string_view file) {
  const Camera& c = settings.camera;
  const CameraKeys& given = settings.camera_given;
  const int at = settings.line_of({"camera.near", "camera.far", "camera.eye", "camera.target"});
  const bool framed = settings.gives("volume") || !is_plane(settings.surfels);
  if (!framed || (given.near && given.far))
    throw UserError(
        file, at, fmt::format("camera.near is {:g} and camera.far {:g}, expected near < far", c.near, c.far));
  if (given.near)
    throw UserError(
        file, at,
        fmt::format("camera.near is {:g}, but what is to be seen ends {:g} from the eye, expected less",
                    c.near, c.far));
  if (given.far)
    throw UserError(
        file, at,
        fmt::format("camera.far is {:g}, but what is to be seen begins {:g} from the eye, expected more",
                    c.far, c.near));
  throw UserError(
      file, at,
      fmt::format("seen from camera.eye {} toward camera.target {} all has the same depth in binary64, "
                  "expected an eye nearer to what is to be seen",
                  text_of(c.eye), text_of(c.target)));
}

// A volume has no use for the tables of surfels.
void check_volume_alone(const toml::table& root, std::string_view file) {
  for (const auto& [name, node] : root) {
    if (name.str() == "volume" || name.str() == "camera" || name.str() == "frame") continue;
    throw UserError(
        file, line(name),
        fmt::format("[{}] beside [volume], expected [camera], [frame] and [volume] alone", name.str()));
  }
}

}  // namespace

std::vector<NamedFile> files_named(const SceneSettings& settings, const std::filesystem::path& folder) {
  std::vector<NamedFile> files;
  for (const std::string* name :
       {&settings.surfels.file, &settings.volume.file, &settings.volume.positions, &settings.volume.samples})
    if (!name->empty()) files.push_back({"the scene", folder / *name});
  return files;
}

void check_points(const SceneSettings& settings, std::string_view file) {
  check_source(settings, file, kFromPoints);
}

void check_complete_points(const SceneSettings& settings, std::string_view file) {
  if (settings.surfels.neighbours == default_settings().surfels.neighbours) return;
  throw UserError(
      file, settings.line_of({"surfels.neighbours"}),
      "surfels.neighbours beside a file that has radii and normals, expected it removed, or a file "
      "without one of them");
}

void check_camera(const SceneSettings& settings, std::string_view file) {
  const Camera& c = settings.camera;
  const glm::dvec3 view = c.target - c.eye;
  if (glm::length(view) == 0)
    throw UserError(file, settings.line_of({"camera.eye", "camera.target"}),
                    "camera.eye equals camera.target, expected two points");
  if (!(c.near < c.far)) refuse_planes(settings, file);
  const int at = settings.line_of({"camera.up", "camera.eye", "camera.target"});
  if (glm::length(c.up) == 0) throw UserError(file, at, "camera.up is zero, expected a direction");
  if (glm::length(glm::cross(glm::normalize(view), glm::normalize(c.up))) < 1e-9)
    throw UserError(
        file, at,
        fmt::format("camera.up is {}, along the line of sight, expected another direction", text_of(c.up)));
}

SceneSettings parse_settings(std::string_view text, std::string_view file) {
  const toml::table root = parse_toml(text, file);
  SceneSettings settings = default_settings();
  for (const auto& [name, node] : root) {
    if (!is_table(name.str()))
      throw UserError(file, line(name),
                      fmt::format("unknown table \"{}\", expected one of: {}", name.str(), names_of("")));
    if (!node.is_table())
      throw UserError(file, line(name),
                      fmt::format("\"{}\" is a value, expected a table [{}]", name.str(), name.str()));
    settings.lines.emplace(name.str(), line(name));
    read_table(settings, name.str(), *node.as_table(), file);
  }
  settings.camera_given = keys_given(settings);
  check_surfels(settings, file);
  check_capture(settings, file);
  check_refine(settings, file);
  check_hierarchy(settings, file);
  if (settings.gives("volume"))
    check_volume_alone(root, file);
  else if (is_plane(settings.surfels))
    check_camera(settings, file);
  return settings;
}

}  // namespace splatscope::traces
