#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/run.h"
#include "studies/study.h"

// Table 2 of Ren, Pfister, Zwicker, Object Space EWA Surface Splatting (2002), on the simulated machines. Its
// models were never published: ours are stand-ins with as many points.
namespace splatscope::studies {

struct Table2Model {
  std::string_view name;  // as in the paper, and the generator that stands in for it
  std::size_t points;
  struct {
    int resolution;         // pixels: width and height
    double radeon, ti4400;  // frames per second
  } published[2];
};
std::span<const Table2Model> table2_models();
// The stand-in as it is drawn, but for its frame's size and the card's memory.
traces::Scene table2_scene(const Table2Model& model, const Progress& progress = {});

// MiB that are free for vertices on a card with 64 MB, the Radeon 8500, or with 128, the Ti 4400.
double free_video_memory(std::string_view machine);

struct Table2Row {
  std::string model;
  std::size_t points = 0;
  std::size_t drawn = 0;  // points that culling left
  int resolution = 0;     // pixels
  std::string machine;
  double published_fps = 0;
  Rate simulated;

  double error() const { return simulated.fps / published_fps - 1; }
};

// The frames of Ren 2002, Table 2: model by model, the lower resolution and the Radeon first, as printed.
// `fidelity` gives times. Weights are captured from one view only: they say nothing of the time.
std::vector<Table2Row> table2_rows(Fidelity fidelity, const Progress& progress = {});

// The median of the absolute errors of `rows`, which are not empty.
double median_error(std::span<const Table2Row> rows);

void reproduce_table2(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
