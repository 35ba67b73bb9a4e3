#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "traces/models/mesh.h"
#include "traces/output_files.h"
#include "traces/scene_text.h"

// What a user wants drawn: surfels, a camera, and how to splat. It lives on the host; the recorder turns it
// into a trace, which knows no surfel.
namespace splatscope::traces {

// A point sample of a surface (Ren 2002, section 2).
struct Surfel {
  glm::vec3 position{};  // object units
  glm::vec3 normal{};    // of unit length
  float radius = 0;      // h: the largest distance to a neighbouring surfel, object units, > 0
  glm::vec3 color{};     // r g b, each in [0, 1]
};

struct Camera {
  glm::dvec3 eye{};
  glm::dvec3 target{};
  glm::dvec3 up{};
  double fov_y_degrees = 0;  // of the frame's height
  double near = 0;           // distances of the clip planes, object units
  double far = 0;
};

struct FrameSize {
  int width = 0;   // pixels
  int height = 0;  // pixels
};

// The three algorithms of Table 1 (Ren 2002, section 8).
enum class Algorithm { no_ewa, ewa_per_pixel, ewa_per_surfel };
inline constexpr std::array<std::string_view, 3> kAlgorithmNames{"no-ewa", "ewa-per-pixel", "ewa-per-surfel"};

// Automatic: the card's own memory as far as it goes, then AGP memory.
enum class VertexMemory { automatic, video, agp };

enum class Faces { automatic, both, front };

enum class Culling {
  automatic,
  none,   // no hierarchy: every surfel, in the scene's order
  off,    // every block of the hierarchy
  blocks  // what may be seen
};

// How the visibility pass moves the depth image away from the eye (Ren 2002, section 5.1, Fig. 4).
enum class DepthOffsetScheme { viewing_ray, camera_z };

struct Splatting {
  Algorithm algorithm = Algorithm::ewa_per_surfel;
  double cutoff = 0;        // c: the splat ends at sqrt(2c) standard deviations (Eq. 14)
  double depth_offset = 0;  // z_t of the visibility pass, object units (5.1)
  DepthOffsetScheme depth_offset_scheme = DepthOffsetScheme::viewing_ray;
  double gamma = 0;  // scale of the weights, below 1 so that their sums do not saturate (7.2)
  double sigma = 0;  // standard deviation of the reconstruction filter, in units of a surfel's radius
  bool circular_cutoff = false;  // texels beyond the cutoff are 0; else the whole square is used
  int texture_length = 0;        // texels along an edge of the alpha texture; 0: Eq. 16's
  bool refine = false;           // of ewa-per-surfel: a second frame, normalised per pixel (8)
  VertexMemory vertex_memory = VertexMemory::automatic;
  double video_megabytes = 0;  // what vertex and index buffers may take of the card's memory
  Faces faces = Faces::both;   // of a Scene, never automatic: surfels that face away may be dropped
  std::string_view visibility_program = "quad";  // names in kernels::visibility_programs() and ewa_programs()
  std::string_view ewa_program = "paper";
};

// How the weights of per-surfel normalisation are captured (Ren 2002, section 7.2).
struct Capture {
  int views = 0;               // spread evenly over the bounding sphere
  int frame_size = 0;          // pixels: width and height of each view
  bool corner_weights = true;  // a surfel at an edge of the model has a weight for each vertex of its quad
  // Only surfels whose centres lie in this box (object units, faces included) are captured.
  glm::dvec3 box_min{};
  glm::dvec3 box_max{};
};

// How the surfels are drawn block by block (Ren 2002, section 6.2).
struct Hierarchy {
  Culling culling = Culling::none;  // of a Scene, never automatic
  int block_surfels = 0;            // layered depth pixels of a block
  bool levels = false;              // coarser ones where they have enough surfels; false: the finest alone
  double surfels_per_pixel = 0;     // as many are enough
  bool progressive = false;         // several frames, from the coarsest level on
};

// Surfels that were left out while loading, by the first reason that held.
struct SkipCounts {
  std::size_t not_finite = 0;   // a NaN or INF in position, normal, radius or color
  std::size_t zero_radius = 0;  // radius <= 0
  std::size_t duplicate = 0;    // at the position of an earlier one, with the same normal
  std::size_t zero_normal = 0;  // of length 0, or to be fitted to neighbours that lie on one line

  std::size_t total() const { return not_finite + zero_radius + duplicate + zero_normal; }
};

// What a file of points does not have is estimated from the neighbours; of the surfels that were kept.
struct EstimateCounts {
  std::size_t normals = 0;
  std::size_t radii = 0;
};

struct Scene {
  std::string name;              // the scene file's name without folder and ending
  std::vector<NamedFile> files;  // others that it was read from
  std::vector<Surfel> surfels;
  SkipCounts skipped;
  EstimateCounts estimated;
  MeshCounts mesh;  // all 0 where the surfels come from no mesh
  Camera camera;
  FrameSize frame;
  Splatting splatting;
  Capture capture;
  Hierarchy hierarchy;
};

// Reads a scene file (TOML). Each key has a default (scene_keys.h). A surfel file's name is relative to the
// scene file. `name_or_path` may also be the name of a ready scene ("checkerboard-no-ewa") where no such file
// exists. Throws UserError: file missing, TOML wrong, key unknown, value of the wrong type or out of range.
Scene load_scene(const std::filesystem::path& name_or_path, const std::function<void(double)>& progress = {});
// The same of a text that was read: a pipe gives it but once.
Scene load_scene(const SceneText& text, const std::function<void(double)>& progress = {});

// The same from text; `file` is for messages and for finding the surfel file.
Scene parse_scene(std::string_view text, const std::filesystem::path& file,
                  const std::function<void(double)>& progress = {});

// "2 left out (1 not finite, 1 of radius 0)", or "none left out".
std::string describe(const SkipCounts& skipped);

// The two, with ", 7 normals estimated, 7 radii estimated" where there are such.
std::string describe(const SkipCounts& skipped, const EstimateCounts& estimated);

// "from 1000 triangles, 3 left out (3 without area), 12 normals computed"; empty where there is no mesh.
std::string describe(const MeshCounts& mesh);
std::string describe_left_out(const MeshCounts& mesh);  // "2 left out (2 without area)"; empty: none

// "no-ewa", "ewa-per-pixel", "ewa-per-surfel": as in scene files and results.
std::string_view name(Algorithm algorithm);

}  // namespace splatscope::traces
