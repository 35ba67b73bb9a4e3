#include "studies/studies.h"

#include <array>

#include "studies/vertex_data.h"

namespace splatscope::studies {

std::span<const Study> own_studies() {
  static constexpr std::array kStudies = {
      Study{"vertex-data",
            "instructions against bytes a vertex, in video and in AGP memory (Ren 2002, section 8)",
            study_vertex_data},
  };
  return kStudies;
}

}  // namespace splatscope::studies
