#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "traces/framing.h"
#include "traces/models/patterns.h"
#include "traces/scene.h"
#include "traces/volumes/volume_keys.h"

// Every key of a scene file, declared once: parsing, error messages and the documentation come from it.
namespace splatscope::traces {

enum class Generator { plane, sphere, torus_knot, salamander, chameleon, wasp, fiesta };

struct SurfelSource {
  std::string file;  // empty: the generator
  Generator generator = Generator::plane;
  int columns = 0, rows = 0;  // of the plane
  int checker_square = 0;     // surfels
  glm::dvec3 checker_light{}, checker_dark{};
  int count = 0;  // to sample from a mesh or a model; 0: the model's own number, or kMeshSurfels
  Pattern pattern = Pattern::own;
  double pattern_scale = 0;  // radii of the bounding sphere
  double shading = 0;
  bool mirror = false;
  int neighbours = 0;  // whose largest distance is the radius, and that the normal is fitted to
};

inline bool is_plane(const SurfelSource& source) {
  return source.file.empty() && source.generator == Generator::plane;
}

inline constexpr std::size_t kMeshSurfels = 100000;

// A scene file's values before surfels are made.
struct SceneSettings {
  SurfelSource surfels;
  Camera camera;
  CameraKeys camera_given;
  int width = 0, height = 0;
  Splatting splatting;
  Capture capture;
  Hierarchy hierarchy;
  double depth_offset = 0;  // 0: the average spacing
  VolumeKeys volume;
  std::map<std::string, int, std::less<>>
      lines;  // of what the file gives: tables ("camera"), keys ("camera.up")

  bool gives(std::string_view name) const { return lines.contains(name); }
  // Of the first of these that the file gives; 0: of none.
  int line_of(std::initializer_list<std::string_view> names) const;
};

// Each kind of value finds its place in the settings, and knows its default and range.
struct RealValue {
  double& (*place)(SceneSettings&);
  double initial;
  double min, max;  // both allowed
};
struct IntegerValue {
  int& (*place)(SceneSettings&);
  int initial;
  int min, max;  // both allowed
};
struct BooleanValue {
  bool& (*place)(SceneSettings&);
  bool initial;
};
struct TextValue {
  std::string& (*place)(SceneSettings&);
  std::string_view initial;
};
struct ChoiceValue {
  void (*store)(SceneSettings&, int);
  std::vector<std::string_view> names;
  int initial;  // place in `names`
};
struct VectorValue {  // three numbers
  glm::dvec3& (*place)(SceneSettings&);
  glm::dvec3 initial;
  double min, max;  // of each number, both allowed
};

struct TransferValue {  // { value, opacity, color } each, values rising; none by default
  std::vector<kernels::TransferPoint>& (*place)(SceneSettings&);
};

struct PlacesValue {  // rising numbers; none by default
  std::vector<double>& (*place)(SceneSettings&);
  double min, max;  // of each, both allowed
};

struct SceneKey {
  std::string_view table;
  std::string_view name;
  std::string_view unit;
  std::string_view description;
  std::variant<RealValue, IntegerValue, BooleanValue, TextValue, ChoiceValue, VectorValue, TransferValue,
               PlacesValue>
      value;
};

// Of lambdas, one for each kind of value, for std::visit.
template <class... Parts>
struct Overloaded : Parts... {
  using Parts::operator()...;
};
template <class... Parts>
Overloaded(Parts...) -> Overloaded<Parts...>;

std::span<const SceneKey> scene_keys();
std::span<const SceneKey> volume_keys();  // those of [volume], which are among them

// "a number from 0 to 10", for messages and documentation.
std::string expectation(const SceneKey& key);
// The same of an entry of an array whose length is free.
std::string entry_expectation(const SceneKey& key);

// "0.73", as it would stand in a scene file.
std::string default_text(const SceneKey& key);

// All of them as a Markdown table, for the user's guide.
std::string describe_keys();

SceneSettings default_settings();

}  // namespace splatscope::traces
