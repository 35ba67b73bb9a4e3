#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "kernels/view.h"

// Where the rays of pixels meet a parallelogram.
namespace splatscope::kernels {

struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;  // right and bottom excluded
};

// Pixels whose centres may lie in the picture of the parallelogram o +- a +- b (camera space), cut at the
// near plane; empty where it lies before that.
PixelBox bounding_box(const View& view, const glm::dvec3& o, const glm::dvec3& a, const glm::dvec3& b);

// Pixels whose centres may lie within `reach` of `center` (pixels) along x and y.
PixelBox box_about(const View& view, const glm::dvec2& center, const glm::dvec2& reach);

// Linear in the window coordinates: dot(normal, ray), where ray is the pixel's direction with z = 1.
struct RayFunction {
  double at_origin = 0, by_x = 0, by_y = 0;
  RayFunction() = default;
  RayFunction(const View& view, const glm::dvec3& normal)
      : at_origin(normal.z - normal.x * view.center().x / view.eta + normal.y * view.center().y / view.eta),
        by_x(normal.x / view.eta),
        by_y(-normal.y / view.eta) {}
  double operator()(double x, double y) const { return at_origin + by_x * x + by_y * y; }
};

struct RayHit {
  double z = 0;    // camera z; not finite where the ray lies in the plane, negative behind the eye
  glm::dvec2 y{};  // the point is o + y.x a + y.y b
};

// The plane o + y.x a + y.y b (camera space) under the rays of window positions: Cramer's rule for o + y.x a
// + y.y b = z ray.
class RayPlane {
 public:
  RayPlane() = default;
  RayPlane(const View& view, const glm::dvec3& o, const glm::dvec3& a, const glm::dvec3& b);
  RayHit operator()(double x, double y) const {
    const double scale = 1.0 / denominator_(x, y);
    return {plane_ * scale, {numerator0_(x, y) * scale, numerator1_(x, y) * scale}};
  }

 private:
  RayFunction denominator_, numerator0_, numerator1_;
  double plane_ = 0;  // dot(o, normal)
};

}  // namespace splatscope::kernels
