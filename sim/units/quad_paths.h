#pragma once

#include "sim/kernel/channel.h"
#include "sim/units/draw_unit.h"

namespace splatscope::sim {

using Quads = Channel<std::uint32_t>;  // numbers of quads of the draw

// Where quads come from, by the unit before; null: the machine has no such way.
struct QuadSources {
  Quads* raster = nullptr;
  Quads* depth = nullptr;
  Quads* texture = nullptr;

  // Of a unit behind those that are given.
  Quads* of(const DrawJob& job) const {
    if (texture && job.textured) return texture;
    return depth && uses_depth(*job.draw) ? depth : raster;
  }
};

// Where quads go, by the unit behind.
struct QuadTargets {
  Quads* depth = nullptr;
  Quads* texture = nullptr;
  Quads* pixel = nullptr;

  // Null: quads of this draw end here.
  Quads* of(const DrawJob& job) const {
    if (depth && uses_depth(*job.draw)) return depth;
    if (!job.draw->state.color_write) return nullptr;
    return texture && job.textured ? texture : pixel;
  }
};

}  // namespace splatscope::sim
