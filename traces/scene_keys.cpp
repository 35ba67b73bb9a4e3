#include "traces/scene_keys.h"

#include <fmt/format.h>

#include <array>

#include "kernels/splat_programs.h"
#include "traces/trace_file.h"

namespace splatscope::traces {
namespace {

constexpr double kFar = 1e30;  // no scene needs more, and squares of it still fit a double

using S = SceneSettings;

std::vector<std::string_view> names_of(std::span<const kernels::SplatProgram> programs) {
  std::vector<std::string_view> names;
  for (const kernels::SplatProgram& program : programs) names.push_back(program.name);
  return names;
}

std::string_view name_of(std::span<const kernels::SplatProgram> programs, int choice) {
  return programs[static_cast<std::size_t>(choice)].name;
}

// The default picture is Fig. 11 of Ren 2002: a plane of 64k surfels that recedes toward the horizon. The
// paper gives neither its camera nor the size of its squares: these are a reconstruction. The camera's
// defaults are the plane's; other surfels are framed (framing.h).
const std::array kKeys = {
    SceneKey{"surfels", "file", "",
             "surfel file (PLY) or mesh, relative to the scene file; empty: `generator` makes them",
             TextValue{[](S& s) -> std::string& { return s.surfels.file; }, ""}},
    SceneKey{"surfels", "generator", "", "what makes the surfels where no file is given",
             ChoiceValue{[](S& s, int i) { s.surfels.generator = Generator(i); },
                         {"plane", "sphere", "torus-knot", "salamander", "chameleon", "wasp", "fiesta"},
                         0}},
    SceneKey{"surfels", "columns", "surfels", "of the plane y = 0, along x, one unit apart, centred",
             IntegerValue{[](S& s) -> int& { return s.surfels.columns; }, 256, 1, 4096}},
    SceneKey{"surfels", "rows", "surfels", "of the plane, along z",
             IntegerValue{[](S& s) -> int& { return s.surfels.rows; }, 256, 1, 4096}},
    SceneKey{"surfels", "checker_square", "surfels", "edge of a square of the plane's checkerboard",
             IntegerValue{[](S& s) -> int& { return s.surfels.checker_square; }, 8, 1, 4096}},
    SceneKey{"surfels", "checker_light", "r g b", "colour of the squares with an even number",
             VectorValue{[](S& s) -> glm::dvec3& { return s.surfels.checker_light; }, {1, 1, 1}, 0, 1}},
    SceneKey{"surfels", "checker_dark", "r g b", "colour of the others",
             VectorValue{[](S& s) -> glm::dvec3& { return s.surfels.checker_dark; }, {0, 0, 0}, 0, 1}},
    SceneKey{"surfels", "count", "surfels",
             "taken from a mesh or a model, exactly; 0: as many as the model has, 100000 from a mesh",
             IntegerValue{[](S& s) -> int& { return s.surfels.count; }, 0, 0, 1 << 24}},
    SceneKey{"surfels", "pattern", "", "solid pattern on a mesh or a model; own: the colours that it has",
             ChoiceValue{[](S& s, int i) { s.surfels.pattern = Pattern(i); },
                         {pattern_names().begin(), pattern_names().end()},
                         0}},
    SceneKey{"surfels", "pattern_scale", "radii of the bounding sphere", "size of a square, stripe or spot",
             RealValue{[](S& s) -> double& { return s.surfels.pattern_scale; }, 0.06, 1e-4, 10}},
    SceneKey{"surfels", "shading", "",
             "how far surfels of a mesh or a model that face away from the light are darkened; 0: not at all",
             RealValue{[](S& s) -> double& { return s.surfels.shading; }, 0.75, 0, 1}},
    SceneKey{"surfels", "mirror", "",
             "mirrors a file's or a model's surfels in x: for files whose coordinates are right-handed",
             BooleanValue{[](S& s) -> bool& { return s.surfels.mirror; }, false}},
    SceneKey{"surfels", "neighbours", "surfels",
             "nearest neighbours that a radius or normal is estimated from where the file has none",
             IntegerValue{[](S& s) -> int& { return s.surfels.neighbours; }, 8, 3, 64}},

    SceneKey{"camera", "eye", "object units", "where the camera is",
             VectorValue{[](S& s) -> glm::dvec3& { return s.camera.eye; }, {0, 70, 225}, -kFar, kFar}},
    SceneKey{"camera", "target", "object units", "what it looks at",
             VectorValue{[](S& s) -> glm::dvec3& { return s.camera.target; }, {0, 0, 30}, -kFar, kFar}},
    SceneKey{"camera", "up", "", "direction that is up in the picture",
             VectorValue{[](S& s) -> glm::dvec3& { return s.camera.up; }, {0, 1, 0}, -kFar, kFar}},
    SceneKey{"camera", "fov_y_degrees", "degrees", "angle of view over the frame's height",
             RealValue{[](S& s) -> double& { return s.camera.fov_y_degrees; }, 75, 0.01, 179}},
    SceneKey{"camera", "near", "object units", "distance of the near clip plane",
             RealValue{[](S& s) -> double& { return s.camera.near; }, 1, 1e-6, kFar}},
    SceneKey{"camera", "far", "object units", "distance of the far clip plane, beyond `near`",
             RealValue{[](S& s) -> double& { return s.camera.far; }, 1000, 1e-6, kFar}},

    SceneKey{"frame", "width", "pixels", "width of the picture",
             IntegerValue{[](S& s) -> int& { return s.width; }, 512, 1, kMostFrameEdge}},
    SceneKey{"frame", "height", "pixels", "height of the picture",
             IntegerValue{[](S& s) -> int& { return s.height; }, 512, 1, kMostFrameEdge}},

    SceneKey{"splatting", "algorithm", "", "row of Table 1",
             ChoiceValue{[](S& s, int i) { s.splatting.algorithm = Algorithm(i); },
                         {kAlgorithmNames.begin(), kAlgorithmNames.end()},
                         2}},
    SceneKey{"splatting", "cutoff", "", "c: a splat ends at sqrt(2c) standard deviations (Ren 2002, Eq. 14)",
             RealValue{[](S& s) -> double& { return s.splatting.cutoff; }, 1, 0.25, 8}},
    SceneKey{"splatting", "depth_offset", "object units",
             "z_t of the visibility pass (Ren 2002, 5.1); 0: the average spacing of the surfels",
             RealValue{[](S& s) -> double& { return s.depth_offset; }, 0, 0, kFar}},
    SceneKey{"splatting", "depth_offset_scheme", "",
             "direction of z_t: the paper's, or the camera's axis, which hides what it should not (Fig. 4)",
             ChoiceValue{[](S& s, int i) { s.splatting.depth_offset_scheme = DepthOffsetScheme(i); },
                         {"viewing-ray", "camera-z"},
                         0}},
    SceneKey{
        "splatting", "gamma", "",
        "scale of the weights against saturation (Ren 2002, 7.2); 0: 0.73, or less where more splats overlap",
        RealValue{[](S& s) -> double& { return s.splatting.gamma; }, 0, 0, 1}},
    // 1: V_r = I where the radius h is the unit. On a square grid h is sqrt 2 spacings; the truncated splats
    // then sum to at most 1.355, whose inverse is about the paper's gamma = 0.73.
    SceneKey{"splatting", "sigma", "radii", "standard deviation of the reconstruction filter",
             RealValue{[](S& s) -> double& { return s.splatting.sigma; }, 1, 0.01, 10}},
    SceneKey{"splatting", "circular_cutoff", "", "texels further than `cutoff` from the centre are 0",
             BooleanValue{[](S& s) -> bool& { return s.splatting.circular_cutoff; }, true}},
    SceneKey{"splatting", "refine", "",
             "after the frame of ewa-per-surfel, for a moving eye, one normalised per pixel, for a still one",
             BooleanValue{[](S& s) -> bool& { return s.splatting.refine; }, false}},
    SceneKey{"splatting", "texture_length", "texels",
             "width and height of the alpha texture; 0: the least that Eq. 16 allows for `cutoff`",
             IntegerValue{[](S& s) -> int& { return s.splatting.texture_length; }, 0, 0, kMaxTextureEdge}},
    SceneKey{
        "splatting", "vertex_memory", "",
        "where the vertex buffers lie; auto: in video memory until `video_megabytes` are full",
        ChoiceValue{
            [](S& s, int i) { s.splatting.vertex_memory = VertexMemory(i); }, {"auto", "video", "agp"}, 0}},
    // Of a card with 64 MB, the Radeon 8500, less the frame and the desktop. A Ti 4400 has 64 more.
    SceneKey{"splatting", "video_megabytes", "MiB", "video memory that is free for vertices and indices",
             RealValue{[](S& s) -> double& { return s.splatting.video_megabytes; }, 56, 0, 4096}},
    SceneKey{"splatting", "faces", "",
             "which surfels are drawn; front: those that face the eye; auto: both of the plane, else front",
             ChoiceValue{[](S& s, int i) { s.splatting.faces = Faces(i); }, {"auto", "both", "front"}, 0}},
    SceneKey{"splatting", "visibility_program", "", "program of the first pass, with its vertices",
             ChoiceValue{[](S& s, int i) {
                           s.splatting.visibility_program = name_of(kernels::visibility_programs(), i);
                         },
                         names_of(kernels::visibility_programs()), 0}},
    SceneKey{"splatting", "ewa_program", "", "program of the second pass where it filters by EWA",
             ChoiceValue{[](S& s, int i) { s.splatting.ewa_program = name_of(kernels::ewa_programs(), i); },
                         names_of(kernels::ewa_programs()), 0}},

    SceneKey{
        "hierarchy", "culling", "",
        "none: no hierarchy; off: every block of it is drawn; blocks: those that may be seen, for the "
        "same picture; auto: none for the plane, else blocks",
        ChoiceValue{
            [](S& s, int i) { s.hierarchy.culling = Culling(i); }, {"auto", "none", "off", "blocks"}, 0}},
    SceneKey{"hierarchy", "block_surfels", "surfels", "about as many in a block: 4, 16, 64, 256, ...",
             IntegerValue{[](S& s) -> int& { return s.hierarchy.block_surfels; }, 256, 1, 65536}},
    SceneKey{"hierarchy", "level", "",
             "of the tree; auto: for each block the coarsest with `surfels_per_pixel`",
             ChoiceValue{[](S& s, int i) { s.hierarchy.levels = i == 1; }, {"finest", "auto"}, 0}},
    SceneKey{"hierarchy", "surfels_per_pixel", "surfels", "that a coarser level must have on the screen",
             RealValue{[](S& s) -> double& { return s.hierarchy.surfels_per_pixel; }, 1, 1e-4, 1e4}},
    SceneKey{"hierarchy", "progressive", "",
             "several frames: from the coarsest level on, each refined by one level",
             BooleanValue{[](S& s) -> bool& { return s.hierarchy.progressive; }, false}},

    SceneKey{"capture", "views", "views",
             "spread evenly over the bounding sphere, that per-surfel weights are captured from",
             IntegerValue{[](S& s) -> int& { return s.capture.views; }, 32, 1, 256}},
    SceneKey{"capture", "frame_size", "pixels", "width and height of each of these views",
             IntegerValue{[](S& s) -> int& { return s.capture.frame_size; }, 512, 16, 2048}},
    SceneKey{"capture", "corner_weights", "",
             "surfels at an edge of the model have a weight for each vertex of their quads",
             BooleanValue{[](S& s) -> bool& { return s.capture.corner_weights; }, true}},
    SceneKey{
        "capture", "box_min", "object units",
        "only surfels with centres in a box are captured, the others stay as dark as gamma makes them",
        VectorValue{[](S& s) -> glm::dvec3& { return s.capture.box_min; }, glm::dvec3(-kFar), -kFar, kFar}},
    SceneKey{
        "capture", "box_max", "object units", "the box's other corner",
        VectorValue{[](S& s) -> glm::dvec3& { return s.capture.box_max; }, glm::dvec3(kFar), -kFar, kFar}},
};

std::string quoted_list(const std::vector<std::string_view>& names) {
  std::string list;
  for (std::string_view name : names) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name);
  return list;
}

}  // namespace

int SceneSettings::line_of(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names)
    if (const auto found = lines.find(name); found != lines.end()) return found->second;
  return 0;
}

std::span<const SceneKey> scene_keys() {
  static const std::vector<SceneKey> kAll = [] {
    std::vector<SceneKey> keys(kKeys.begin(), kKeys.end());
    keys.insert(keys.end(), volume_keys().begin(), volume_keys().end());
    return keys;
  }();
  return kAll;
}

std::string expectation(const SceneKey& key) {
  return std::visit(
      Overloaded{
          [](const RealValue& v) { return fmt::format("a number from {:g} to {:g}", v.min, v.max); },
          [](const IntegerValue& v) { return fmt::format("a whole number from {} to {}", v.min, v.max); },
          [](const BooleanValue&) { return std::string("true or false"); },
          [](const TextValue&) { return std::string("a string"); },
          [](const ChoiceValue& v) { return (v.names.size() > 1 ? "one of " : "") + quoted_list(v.names); },
          [](const VectorValue& v) {
            return fmt::format("an array of three numbers from {:g} to {:g}", v.min, v.max);
          },
          [](const TransferValue&) {
            return std::string(
                "an array of { value, opacity, color }, values that do not fall (of two that are the same "
                "the later begins a step), opacity and color from 0 to 1");
          },
          [](const PlacesValue& v) {
            return fmt::format("an array of rising numbers from {:g} to {:g}", v.min, v.max);
          }},
      key.value);
}

std::string entry_expectation(const SceneKey& key) {
  if (const auto* places = std::get_if<PlacesValue>(&key.value))
    return fmt::format("a number from {:g} to {:g}, above the one before it", places->min, places->max);
  return "{ value, opacity, color }, its value not below the one before it, opacity and color from 0 to 1";
}

std::string default_text(const SceneKey& key) {
  return std::visit(
      Overloaded{[](const RealValue& v) { return fmt::format("{:g}", v.initial); },
                 [](const IntegerValue& v) { return fmt::format("{}", v.initial); },
                 [](const BooleanValue& v) { return fmt::format("{}", v.initial); },
                 [](const TextValue& v) { return fmt::format("\"{}\"", v.initial); },
                 [](const ChoiceValue& v) { return fmt::format("\"{}\"", v.names[std::size_t(v.initial)]); },
                 [](const VectorValue& v) {
                   return fmt::format("[{:g}, {:g}, {:g}]", v.initial.x, v.initial.y, v.initial.z);
                 },
                 [](const TransferValue&) { return std::string("[]"); },
                 [](const PlacesValue&) { return std::string("[]"); }},
      key.value);
}

std::string describe_keys() {
  std::string text = "| key | default | allowed | unit | what it is |\n|---|---|---|---|---|\n";
  for (const SceneKey& key : scene_keys())
    text += fmt::format("| `{}.{}` | `{}` | {} | {} | {} |\n", key.table, key.name, default_text(key),
                        expectation(key), key.unit, key.description);
  return text;
}

SceneSettings default_settings() {
  SceneSettings settings;
  for (const SceneKey& key : scene_keys()) {
    std::visit(Overloaded{[&](const ChoiceValue& v) { v.store(settings, v.initial); },
                          [&](const TextValue& v) { v.place(settings) = std::string(v.initial); },
                          [&](const TransferValue& v) { v.place(settings).clear(); },
                          [&](const PlacesValue& v) { v.place(settings).clear(); },
                          [&](const auto& v) { v.place(settings) = v.initial; }},
               key.value);
  }
  return settings;
}

}  // namespace splatscope::traces
