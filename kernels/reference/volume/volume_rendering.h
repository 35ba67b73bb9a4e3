#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "kernels/reference/volume/footprint.h"
#include "kernels/reference/volume/volume_splats.h"
#include "kernels/view.h"

// EWA volume splatting with sheets (Zwicker 2002, section 7.1), in double precision: the yardstick for the
// fast renderer and for the machine.
namespace splatscope::kernels {

// Phong's model at every voxel, on both sides of the gradient; a voxel without one has ambient and diffuse
// light in full.
struct PhongLight {
  double ambient = 0.3, diffuse = 0.7, specular = 0.2;
  double shininess = 20;
  glm::dvec3 toward_light{0, 0, -1};  // camera space, of unit length: from behind the eye
};

struct VolumeSettings {
  Projection projection = Projection::perspective;
  VolumePrefilter prefilter = VolumePrefilter::ewa;
  // A splat ends at the radial index r = cutoff (section 7.1). At 11 a layer of constant opacity is constant
  // to 0.3%, at 4 to 8% (study volume-ripple).
  double cutoff = 11;
  PhongLight light{};
  // Of the sheets: 0 x, 1 y, 2 z of object space; else the one most parallel to the line of sight.
  std::optional<int> axis{};
};

struct VolumePicture {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec4> pixels;  // r g b times opacity, and opacity; rows from the top
  std::size_t left_out = 0;        // splats not between the near and the far plane, outside of the
                                   // picture, or without a finite footprint
  std::size_t sheets = 0;          // that have a splat in the picture
};

// Sheets are the layers of voxels along the axis most parallel to the line of sight (sheet_axis). The splats
// of each add up: weight by footprint, divided by the part of a Gaussian within the cutoff; opacities above 1
// count as 1. The sheets are composited from back to front. A flat kernel's opacity grows the less with the
// slope of its plane the flatter it is (flattened_weight), and a surface's not at all. Several threads; the
// same bits for any number of them.
VolumePicture volume_picture(const View& view, const VolumeSplats& splats, const VolumeSettings& settings,
                             const std::function<void(double)>& progress = {});

// Colour of a splat at `camera` under Phong's model.
glm::dvec3 shaded(const PhongLight& light, Projection projection, const glm::dvec3& camera,
                  const glm::dvec3& camera_normal, const glm::dvec3& color);

// Weight times peak times this is the opacity at a splat's centre: it brings the path's length from camera
// to object units and divides by the part of a Gaussian within the cutoff.
double opacity_scale(const View& view, double cutoff);

}  // namespace splatscope::kernels
