#include "studies/studies.h"

#include <array>

#include "studies/alpha_texture.h"
#include "studies/exploration.h"
#include "studies/extremes.h"
#include "studies/fidelity.h"
#include "studies/growth.h"
#include "studies/hierarchy.h"
#include "studies/picture_quality.h"
#include "studies/precision.h"
#include "studies/software_comparison.h"
#include "studies/vertex_data.h"
#include "studies/volume_ripple.h"

namespace splatscope::studies {

std::span<const Study> own_studies() {
  static constexpr std::array kStudies = {
      Study{"fidelity", "the five fidelities: speed against accuracy", study_fidelity},
      Study{"growth", "time and memory of a frame by its surfels, from 10,000 to a million", study_growth},
      Study{"vertex-data",
            "instructions against bytes a vertex, in video and in AGP memory (Ren 2002, section 8)",
            study_vertex_data},
      Study{"software",
            "screen-space EWA in software against the machines, by resolution (Ren 2002, section 8)",
            study_software},
      Study{"alpha-texture", "the size of the alpha texture, for any cutoff (Ren 2002, Eq. 15 and 16)",
            study_alpha_texture},
      Study{"quality",
            "pictures of models against the double-precision reference, and what keeps them from it",
            study_quality},
      Study{"hierarchy", "blocks culled, levels chosen, frames refined (Ren 2002, section 6.2)",
            study_hierarchy},
      Study{"exploration", "shorter programs, and hardware that Ren 2002 did not have", study_exploration},
      Study{"precision", "what each lossy step of the machine costs the picture", study_precision},
      Study{"volume-ripple", "a volume's layer of constant voxels, by the cutoff of its splats",
            study_volume_ripple},
      Study{"extremes", "where the formulas of the paper break, and what guards cost", study_extremes},
  };
  return kStudies;
}

}  // namespace splatscope::studies
