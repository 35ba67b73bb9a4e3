#include "studies/volume_pictures.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <vector>

#include "kernels/reference/volume/footprint.h"
#include "kernels/reference/volume/procedural.h"

namespace splatscope::studies {
namespace {

// Weights of the finer samples along one axis, and the first of them.
struct Taps {
  int first = 0;
  std::vector<float> weights;
};

// A finer sample j lies at (j + kFiner/2)/kFiner pixels: View::center() is half a pixel off the middle in
// either view, and so are not the same points.
Taps taps_of(int pixel, int samples, LowPass filter) {
  constexpr double kReach = 4;  // pixels, of the Gaussian
  const double center = pixel + 0.5, reach = filter == LowPass::gaussian ? kReach : 0.5;
  Taps taps;
  double sum = 0;
  std::vector<double> weights;
  for (int j = std::max(0, static_cast<int>((center - reach - 1) * kFiner)); j < samples; ++j) {
    const double distance = (j + 0.5 * kFiner) / kFiner - center;
    if (distance >= reach) break;
    if (distance < -reach) continue;
    if (weights.empty()) taps.first = j;
    weights.push_back(filter == LowPass::gaussian ? std::exp(-0.5 * distance * distance) : 1.0);
    sum += weights.back();
  }
  for (const double weight : weights) taps.weights.push_back(static_cast<float>(weight / sum));
  return taps;
}

std::array<float, 4> weighted(const Taps& taps, const auto& sample) {
  std::array<float, 4> sum{};
  for (std::size_t i = 0; i < taps.weights.size(); ++i) {
    const std::array<float, 4>& value = sample(taps.first + static_cast<int>(i));
    for (std::size_t c = 0; c < 4; ++c) sum[c] += taps.weights[i] * value[c];
  }
  return sum;
}

}  // namespace

Image picture_of(const kernels::FastVolumePicture& picture, const glm::dvec3& background) {
  Image image(picture.width, picture.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::vec4& pixel = picture.pixels[i];
    for (int c = 0; c < 3; ++c) {
      image.pixels[i][static_cast<std::size_t>(c)] =
          pixel[c] + (1 - pixel.w) * static_cast<float>(background[c]);
    }
    image.pixels[i][3] = 1;
  }
  return image;
}

kernels::View finer(const kernels::View& view) {
  kernels::View fine = view;
  fine.width *= kFiner;
  fine.height *= kFiner;
  fine.eta *= kFiner;
  return fine;
}

Image low_passed(const Image& fine, LowPass filter) {
  Image narrow(fine.width / kFiner, fine.height);
  Image result(narrow.width, fine.height / kFiner);
  oneapi::tbb::parallel_for(0, fine.height, [&](int y) {
    for (int x = 0; x < narrow.width; ++x) {
      narrow.at(x, y) = weighted(taps_of(x, fine.width, filter), [&](int j) { return fine.at(j, y); });
    }
  });
  oneapi::tbb::parallel_for(0, result.height, [&](int y) {
    const Taps taps = taps_of(y, fine.height, filter);
    for (int x = 0; x < result.width; ++x) {
      result.at(x, y) = weighted(taps, [&](int j) { return narrow.at(x, j); });
    }
  });
  return result;
}

double psnr_inside(const Image& a, const Image& b, int margin) {
  std::vector<unsigned char> mask(a.pixels.size());
  for (int y = margin; y < a.height - margin; ++y) {
    for (int x = margin; x < a.width - margin; ++x) {
      mask[static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x)] = 1;
    }
  }
  return psnr(a, b, mask);
}

Image zebra_picture(const kernels::View& view, double height, double period, const glm::dvec3& background) {
  Image image(view.width, view.height);
  const glm::dmat4 to_object = glm::inverse(view.object_to_camera);
  const auto object = [&](const glm::dvec3& ray) {
    return glm::dvec3(to_object *
                      glm::dvec4(from_ray_space(view, kernels::Projection::perspective, ray), 1.0));
  };
  oneapi::tbb::parallel_for(0, view.height, [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      const glm::dvec3 start = object({x + 0.5, y + 0.5, 0}), ahead = object({x + 0.5, y + 0.5, 1}) - start;
      const double along = (height - start.z) / ahead.z;
      const glm::dvec3 p = start + along * ahead;
      const bool inside = along > 0 && std::abs(p.x) <= 1 && std::abs(p.y) <= 1;
      const glm::dvec3 color = inside ? glm::dvec3(kernels::zebra(p.x, p.y, period)) : background;
      image.at(x, y) = {static_cast<float>(color.r), static_cast<float>(color.g), static_cast<float>(color.b),
                        1};
    }
  });
  return image;
}

}  // namespace splatscope::studies
