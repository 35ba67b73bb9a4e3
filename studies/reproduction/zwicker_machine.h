#pragma once

#include <string>
#include <vector>

#include "model/number/formats.h"
#include "studies/image_io.h"
#include "studies/reproduction/volume_models.h"
#include "studies/run.h"
#include "studies/study.h"

// EWA volume splatting on the machines of 2002: what Zwicker 2002 wished for in its last section, on
// stand-ins for the volumes of its Fig. 16.
namespace splatscope::studies {

// A machine's picture of a volume against the software's with the same sheets, and its time.
struct VolumeFrame {
  std::string machine;
  double psnr = 0;     // dB, over the pixels that the volume covers
  double seconds = 0;  // of a frame
  Rate rate;
};

struct VolumeRow {
  std::string name, stand_in;
  glm::ivec3 size{};
  std::size_t splats = 0, flat = 0, sheets = 0, vertex_bytes = 0;
  double psnr_float = 0;        // dB, with floats everywhere
  double software_seconds = 0;  // of this host: kernels/reference/volume/fast_volume.h
  std::vector<VolumeFrame> frames;
  Image software, machine;  // the latter of the last of them
};

// On both machines by `fidelity`, which gives times.
VolumeRow volume_row(const VolumeModel& model, Fidelity fidelity, const Progress& progress = {});

// One format of frame and sheets; in the wider ones the pixel unit's colours are floats, as they would round
// each contribution to 8 bits. Texture and vertices are as on the machine.
struct FormatRow {
  FrameFormat format{};
  std::vector<VolumeFrame> frames;
};
std::vector<FormatRow> format_rows(const VolumeModel& model, Fidelity fidelity,
                                   const Progress& progress = {});

// What each lossy step of the pixel pipeline costs: one made wide (binary32) at a time, the others as on the
// GeForce4, with the sheets added up as they are and with their gains.
struct StepRow {
  std::string wide;
  double psnr_plain = 0, psnr_gains = 0;  // dB
};
std::vector<StepRow> step_rows(const VolumeModel& model, const Progress& progress = {});

void reproduce_zwicker_figure16(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
