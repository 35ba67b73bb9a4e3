#include "studies/reproduction/reproduction.h"

#include <array>

#include "studies/reproduction/figure10.h"
#include "studies/reproduction/figure11.h"
#include "studies/reproduction/figure12.h"
#include "studies/reproduction/figure3.h"
#include "studies/reproduction/table1.h"
#include "studies/reproduction/table2.h"
#include "studies/reproduction/zwicker_machine.h"
#include "studies/reproduction/zwicker_surfaces.h"
#include "studies/reproduction/zwicker_volumes.h"

namespace splatscope::studies {

std::span<const Study> reproductions() {
  static constexpr std::array kReproductions = {
      Study{"table1", "frame rates of the three algorithms on both machines", reproduce_table1},
      Study{"table2", "frame rates of stand-ins for its four models on both machines", reproduce_table2},
      Study{"fig3", "the depth image of visibility splatting, by the size of its quads", reproduce_figure3},
      Study{"fig4", "the depth offset along camera z and along viewing rays, two surfaces",
            reproduce_figure4},
      Study{"fig5", "the two depth offsets on a model, and z_t from too small to too large",
            reproduce_figure5},
      Study{"fig8", "the object-space EWA resampling filter of a surfel", reproduce_figure8},
      Study{"fig10", "normalisation of the weights: none, in a box, per surfel, per pixel",
            reproduce_figure10},
      Study{"fig11", "a checkerboard by the three algorithms", reproduce_figure11},
      Study{"fig12", "models with textures of high frequency: stand-ins, and real ones where they are",
            reproduce_figure12},
      Study{"zwicker-fig9", "EWA volume splatting: the affine map of a kernel against the exact one",
            reproduce_zwicker_figure9},
      Study{"zwicker-fig13", "EWA volume splatting: filters minified, magnified, anisotropic; Swan's",
            reproduce_zwicker_figure13},
      Study{"zwicker-fig14", "EWA volume splatting: zebra textures by EWA and by Swan's uniform scaling",
            reproduce_zwicker_figure14},
      Study{"zwicker-fig15", "EWA volume splatting: a texture by volume kernels and by surface kernels",
            reproduce_zwicker_figure15},
      Study{"zwicker-fig16", "a head, an engine and a foot as volumes on both machines",
            reproduce_zwicker_figure16},
      Study{"zwicker-fig17", "surface splatting in software: a head, terrain, a helicopter with glass",
            reproduce_zwicker_figure17},
      Study{"zwicker-table1", "frame rates of software surface splatting", reproduce_zwicker_table1},
  };
  return kReproductions;
}

}  // namespace splatscope::studies
