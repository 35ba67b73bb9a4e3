#pragma once

#include <span>
#include <vector>

#include "model/machine/machine.h"
#include "studies/study.h"
#include "traces/scene.h"

// How large the alpha texture must be (Ren 2002, section 5.2, Eq. 15 and 16), for any cutoff c.
namespace splatscope::studies {

// A size of the texture.
struct TextureRow {
  double cutoff = 0;      // c
  int length = 0;         // texels along an edge
  double of_optimal = 0;  // length over that of Eq. 16
  // Of the Gaussian over the whole square.
  int values = 0;        // different ones
  int largest_step = 0;  // between neighbours of a row, in steps of 8 bits
  double repeated = 0;   // of the pairs of neighbours of a row: both are the same
  // The picture against double precision, normalised per pixel, dB: with a float frame buffer, where the
  // texture is all that is rounded; and as the machine has it.
  double psnr_float = 0, psnr = 0;
};

// What the texture of that size holds; no picture.
TextureRow describe_texture(double cutoff, int length);

// The smallest size from which on no texture leaves out a value between neighbours: Eq. 15, on the texels
// themselves. That of Eq. 16 leaves none out; smaller ones are tried, one after the other.
int least_length(double cutoff);

// Pictures of `scene`, which shows a single surface, by textures of `lengths`, with its cutoff.
std::vector<TextureRow> texture_rows(const traces::Scene& scene, std::span<const int> lengths,
                                     const Machine& machine);

void study_alpha_texture(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
