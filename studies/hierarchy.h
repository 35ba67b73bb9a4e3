#pragma once

#include <cstddef>
#include <vector>

#include "model/machine/machine.h"
#include "studies/image_io.h"
#include "studies/study.h"
#include "traces/scene.h"

// What the LDC tree of Ren 2002, section 6.2, saves: blocks culled, levels chosen, frames refined.
namespace splatscope::studies {

// Surfels of a view by their centres and normals, each on its own: what no culling by blocks can exceed.
struct SurfelsOfAView {
  std::size_t outside = 0;      // centre outside of the frustum
  std::size_t facing_away = 0;  // inside of it
};
SurfelsOfAView classify(const traces::Scene& scene);

struct CullingRow {
  std::size_t surfels = 0;
  SurfelsOfAView could_go;
  std::size_t outside = 0, facing_away = 0;  // culled
  std::size_t blocks = 0;                    // drawn
  std::size_t draws = 0;                     // of a pass
  double fps_all = 0, fps = 0;               // with culling off, and by blocks
};

// One view of a scene at throughput fidelity, normalised per surfel with equal weights: rates do not ask for
// them.
CullingRow culling_row(traces::Scene scene, const Machine& machine);

struct LevelRow {
  double spacing_pixels = 0;  // between surfels of the finest level at the target
  std::size_t surfels = 0;    // drawn where the level is chosen
  std::vector<std::size_t> surfels_by_level;
  double fps_finest = 0, fps = 0;
  // dB, normalised per pixel, against the reference of all surfels.
  double psnr_finest = 0, psnr = 0;
};

// A scene from `times` as far away.
LevelRow level_row(traces::Scene scene, double times, const Machine& machine);

struct ProgressiveRow {
  std::size_t surfels = 0;
  double milliseconds = 0;
  double psnr = 0;  // dB, against the last frame, normalised per pixel
  Image picture;
};
std::vector<ProgressiveRow> progressive_rows(traces::Scene scene, const Machine& machine);

void study_hierarchy(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
