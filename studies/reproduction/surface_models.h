#pragma once

#include <string>
#include <vector>

#include "kernels/reference/surfel_filter.h"
#include "kernels/view.h"

// Stand-ins for the three models of Zwicker 2002, Fig. 17 and Table I, of which none is public: as many
// points, other shapes.
namespace splatscope::studies {

struct SurfaceModel {
  std::string name;      // "scanned head", "Matterhorn", "helicopter"
  std::string stand_in;  // what is drawn in its place
  std::vector<kernels::Surfel> surfels;
  std::vector<double> opacities;  // of each surfel; empty: all 1
  double spacing = 0;             // mean distance of neighbours, object units
  kernels::View view;             // of a square frame
};

// Ellipsoid-like head of `points` surfels with noise for features and a fine texture.
SurfaceModel head_model(int points, int size);
// A height field of mountains with rock, meadows and snow; `points` in all.
SurfaceModel terrain_model(int points, int size);
// Ellipsoids in the places of cabin (of glass), seats, boom, fins, skids and rotors. `points` in all.
SurfaceModel helicopter_model(int points, int size);

}  // namespace splatscope::studies
