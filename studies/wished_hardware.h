#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/short_programs.h"
#include "studies/study.h"
#include "traces/scene.h"

// Hardware that Ren 2002 asks for (more vertex units and a division in the frame buffer, section 9; vertices
// made from one, 6.1), wider frame buffers and point sprites, on the scenes of Table 1.
namespace splatscope::studies {

enum class Geometry : std::uint8_t {
  four_vertices,  // a quad is four vertices: 2002
  four_corners,   // a run of the vertex program emits the four corners
  point_sprites   // one vertex, and a square about it
};

// One change to a machine, or several together.
struct Hardware {
  std::string name;
  std::string cost;             // what it takes, for people
  bool short_programs = false;  // passes by "corner" and "facing"; else by the paper's programs
  int vertex_units = 2;
  FrameFormat frame = FrameFormat::unorm8;  // by with_frame
  bool divider = false;                     // four pixels a clock at the end of the frame
  Geometry geometry = Geometry::four_vertices;
};

// As it was; 1 to 8 vertex units; wide frame buffers; the divider; one vertex a quad; all of it: each by the
// paper's programs, some also by the short ones.
std::span<const Hardware> wished_hardware();

struct HardwareRow {
  Hardware hardware;
  std::string machine;
  // By algorithm of Table 1: no-ewa, ewa-per-pixel, ewa-per-surfel.
  struct Cell {
    Rate rate;
    double megabytes = 0;  // 1e6 bytes to and from video memory, a frame
    double psnr = 0;       // dB, against the double-precision reference
  };
  std::vector<Cell> cells;
};

// Draws `scene` under the three algorithms on `machine` with each hardware, at throughput fidelity.
std::vector<HardwareRow> hardware_rows(const traces::Scene& scene, std::string_view machine,
                                       std::span<const Hardware> hardware, const Progress& progress = {});

// What one of these draws, and its dB against the reference.
struct HardwarePicture {
  Image image;
  double psnr = 0;
};
HardwarePicture hardware_picture(const traces::Scene& scene, std::string_view machine,
                                 const Hardware& hardware, traces::Algorithm algorithm);

// A line for the terminal, without its end, and the line above such lines.
std::string header_of_hardware();
std::string line_of(const HardwareRow& row);

}  // namespace splatscope::studies
