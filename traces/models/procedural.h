#pragma once

#include "traces/models/mesh.h"
#include "traces/scene_keys.h"

namespace splatscope::traces {

// Models that are part of the program, mended: no file and no network is needed for them. +y is up, +z the
// front, about 2 units across. The salamander, the chameleon, the wasp and the fiesta are stand-ins of our
// own for the scanned models of Ren 2002, Table 2, which are not public: the same numbers of points, other
// shapes. Not for Generator::plane.
Model make_procedural(Generator generator);

// As many surfels as the model has where a scene does not say: of the stand-ins, those of Table 2.
std::size_t default_count(Generator generator);

}  // namespace splatscope::traces
