#pragma once

#include "sim/units/draw_unit.h"

namespace splatscope::sim {

// Where quads come from, by the unit before; null: the machine has no such way.
struct QuadSources {
  Items* raster = nullptr;
  Items* depth = nullptr;
  Items* texture = nullptr;

  // Of a unit behind those that are given.
  Items* of(const DrawJob& job) const {
    if (texture && job.textured) return texture;
    return depth && uses_depth(*job.draw) ? depth : raster;
  }
};

// Where quads go, by the unit behind.
struct QuadTargets {
  Items* depth = nullptr;
  Items* texture = nullptr;
  Items* pixel = nullptr;

  // Null: quads of this draw end here.
  Items* of(const DrawJob& job) const {
    if (depth && uses_depth(*job.draw)) return depth;
    if (!job.draw->state.color_write) return nullptr;
    return texture && job.textured ? texture : pixel;
  }
};

}  // namespace splatscope::sim
