#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "studies/run.h"
#include "studies/study.h"
#include "traces/scene.h"

// The trade of Ren 2002, section 8: data computed by the vertex programs, or redundant in each vertex.
namespace splatscope::studies {

// A pair of vertex programs, one a pass: names of kernels::visibility_programs() and ewa_programs().
struct ProgramPair {
  std::string_view visibility, ewa;
};

struct VertexDataRow {
  ProgramPair programs;
  std::string machine;
  int visibility_slots = 0, ewa_slots = 0;
  std::uint32_t visibility_bytes = 0, ewa_bytes = 0;  // of a vertex
  Rate video, agp;                                    // where the vertex buffers lie
  double psnr = 0;  // dB, against the same machine's picture by the first pair; infinite where equal

  int slots() const { return visibility_slots + ewa_slots; }
  // Read in a frame for the four vertices of a surfel.
  std::uint32_t surfel_bytes() const { return 4 * (visibility_bytes + ewa_bytes); }
};

// All pairs on both machines at throughput fidelity; the first pair is the paper's. `scene` is drawn per
// surfel normalised, with weights captured on the machine; its programs and vertex memory are not read.
std::vector<VertexDataRow> vertex_data_rows(const traces::Scene& scene, const Progress& progress = {});

// An object a row, for results.json.
nlohmann::ordered_json json_of(const std::vector<VertexDataRow>& rows);

void study_vertex_data(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
