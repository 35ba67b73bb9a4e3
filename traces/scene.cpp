#include "traces/scene.h"

#include <fmt/format.h>

#include "model/error.h"
#include "traces/framing.h"
#include "traces/gamma.h"
#include "traces/models/mesh_file.h"
#include "traces/scene_settings.h"
#include "traces/surfels.h"

namespace splatscope::traces {
namespace {

// "2 apples, 1 pear": what there is none of is not listed.
std::string listed(std::initializer_list<std::pair<std::size_t, std::string_view>> counts) {
  std::string text;
  for (const auto& [count, what] : counts)
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  return text;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& file,
                  const std::function<void(double)>& progress) {
  SceneSettings settings = parse_settings(text, file.string());
  if (settings.gives("volume")) {
    throw UserError(file.string(), settings.line_of({"volume"}),
                    "[volume] in the place of surfels, expected a scene of surfels");
  }
  Scene scene;
  scene.name = file.stem().string();
  scene.files = files_named(settings, file.parent_path());
  scene.frame = {settings.width, settings.height};
  scene.splatting = settings.splatting;
  scene.capture = settings.capture;
  scene.hierarchy = settings.hierarchy;
  const bool plane = is_plane(settings.surfels);
  if (scene.splatting.faces == Faces::automatic) scene.splatting.faces = plane ? Faces::both : Faces::front;
  if (scene.hierarchy.culling == Culling::automatic)
    scene.hierarchy.culling = plane ? Culling::none : Culling::blocks;
  const SurfelSource& source = settings.surfels;
  const bool points = !source.file.empty() && !is_mesh_file(file.parent_path() / source.file);
  if (points) check_points(settings, file.string());
  Surfels surfels = make_surfels(settings, file.parent_path(), progress);
  if (points && !surfels.surfels.empty() && surfels.estimated.normals + surfels.estimated.radii == 0)
    check_complete_points(settings, file.string());
  scene.surfels = std::move(surfels.surfels);
  scene.skipped = surfels.skipped;
  scene.estimated = surfels.estimated;
  scene.mesh = surfels.mesh;
  scene.files.insert(scene.files.end(), surfels.files.begin(), surfels.files.end());
  scene.splatting.depth_offset = settings.depth_offset > 0 ? settings.depth_offset : surfels.average_spacing;
  scene.camera = surfels.camera;
  if (!plane && !scene.surfels.empty()) place_planes(scene, settings.camera_given);
  settings.camera = scene.camera;
  check_camera(settings, file.string());
  if (!(scene.splatting.gamma > 0)) scene.splatting.gamma = suitable_gamma(scene.surfels, scene.splatting);
  return scene;
}

Scene load_scene(const std::filesystem::path& name_or_path, const std::function<void(double)>& progress) {
  return load_scene(read_scene_text(name_or_path), progress);
}

Scene load_scene(const SceneText& text, const std::function<void(double)>& progress) {
  Scene scene = parse_scene(text.text, text.file, progress);
  if (scene.surfels.empty() && scene.skipped.total() > 0)
    throw UserError(text.file.string(), 0,
                    fmt::format("none of its surfels can be drawn: {}, expected at least one that can",
                                describe(scene.skipped)));
  return scene;
}

std::string describe(const SkipCounts& skipped) {
  if (skipped.total() == 0) return "none left out";
  return fmt::format("{} left out ({})", skipped.total(),
                     listed({{skipped.not_finite, "not finite"},
                             {skipped.zero_radius, "of radius 0"},
                             {skipped.duplicate, "at the place of another"},
                             {skipped.zero_normal, "without a normal"}}));
}

std::string describe(const SkipCounts& skipped, const EstimateCounts& estimated) {
  const std::string made =
      listed({{estimated.normals, "normals estimated"}, {estimated.radii, "radii estimated"}});
  return made.empty() ? describe(skipped) : describe(skipped) + ", " + made;
}

std::string describe_left_out(const MeshCounts& mesh) {
  const std::size_t left_out =
      mesh.triangles_not_finite + mesh.triangles_out_of_range + mesh.triangles_degenerate;
  if (left_out == 0) return "";
  return fmt::format("{} left out ({})", left_out,
                     listed({{mesh.triangles_not_finite, "not finite"},
                             {mesh.triangles_out_of_range, "with a corner that does not exist"},
                             {mesh.triangles_degenerate, "without area"}}));
}

std::string describe(const MeshCounts& mesh) {
  if (mesh.triangles == 0) return "";
  std::string text = fmt::format("from {} triangles", mesh.triangles);
  if (const std::string left_out = describe_left_out(mesh); !left_out.empty()) text += ", " + left_out;
  const std::string mended = listed({{mesh.normals_computed, "normals computed"},
                                     {mesh.textures_unreadable, "textures unreadable"},
                                     {mesh.materials_unreadable, "files of materials unreadable"}});
  return mended.empty() ? text : text + ", " + mended;
}

std::string_view name(Algorithm algorithm) {
  return kAlgorithmNames[static_cast<std::size_t>(algorithm)];
}

}  // namespace splatscope::traces
