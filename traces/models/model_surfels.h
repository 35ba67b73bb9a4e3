#pragma once

#include <functional>
#include <vector>

#include "traces/models/mesh.h"
#include "traces/models/patterns.h"
#include "traces/scene.h"

namespace splatscope::traces {

struct ModelOptions {
  std::size_t count = 0;  // surfels
  Pattern pattern = Pattern::own;
  double pattern_scale = 0;  // size of the pattern, in units of the radius of the model's bounding sphere
  double shading = 0;        // 0: none; 1: a surface that faces away from the light is black
  int neighbours = 0;        // whose largest distance is the radius
};

struct ModelSurfels {
  std::vector<Surfel> surfels;
  std::size_t copies = 0;  // of these: equal to an earlier one, as the mesh has no more places (sampler.h)
};

// Exactly `count` surfels of a mended mesh with at least one triangle, by the sampler's default priority and
// distribution. The colours are those of the pattern or of the model's paint, clamped to [0, 1], and darkened
// as by a lamp high in front, a little to the left (+z is the front, +y up): a surfel has one colour, so the
// light is part of it. A surfel alone has no neighbour: its radius is that of a disc with the mesh's area.
ModelSurfels sample_model(const Model& model, const ModelOptions& options,
                          const std::function<void(double)>& progress = {});

}  // namespace splatscope::traces
