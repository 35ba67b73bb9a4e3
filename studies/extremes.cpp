#include "studies/extremes.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/object_space_ewa/splat_accuracy.h"
#include "model/command/load_program.h"
#include "model/error.h"

namespace splatscope::studies {
namespace {

using kernels::plain_view;
using kernels::QuadOutput;
using kernels::Surfel;
using kernels::SurfelRanges;
using kernels::View;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double relative(double value, double exact) {
  const double error = std::abs(value / exact - 1);
  return std::isfinite(error) ? error : kInfinity;
}

ExtremeErrors errors_of(const View& view, const Surfel& surfel, const QuadOutput& quad) {
  const auto filter = kernels::surfel_filter(view, surfel, true);
  if (!filter) return {};
  if (!is_finite(quad)) return {kInfinity, kInfinity};
  const double deviation = kernels::deviation_error(
      kernels::measured_axes(kernels::tangent_plane(view, surfel, quad), kernels::gaussian_coordinates(quad)),
      filter->axes);
  const double weight = surfel.weight * 0.5 * std::numbers::inv_pi / std::sqrt(filter->determinant);
  return {std::isfinite(deviation) ? deviation : kInfinity, relative(quad[0].diffuse.w, weight)};
}

void take_worst(ExtremeErrors& worst, const ExtremeErrors& errors) {
  worst.deviation = std::max(worst.deviation, errors.deviation);
  worst.weight = std::max(worst.weight, errors.weight);
}

Splatter by_program(std::string_view name, Arithmetic arithmetic, std::string_view arithmetic_name) {
  return {fmt::format("{}, {}", name, arithmetic_name),
          [=](const View& view, std::span<const Surfel> surfels) {
            const auto quads = kernels::run_quads(kernels::ewa_program(name), arithmetic, view, 0.0, surfels);
            ExtremeErrors worst;
            for (std::size_t i = 0; i < surfels.size(); ++i)
              take_worst(worst, errors_of(view, surfels[i], quads[i]));
            return worst;
          }};
}

float sign(float x) {
  return x < 0 ? -1.0f : 1.0f;  // Sgn(0) = 1
}

// Appendix A in binary32, as printed: theta by Sgn(Bp), the eigenvalues (q + t)/2 and (q - t)/2. No guards.
ExtremeErrors printed_errors(const View& view, const Surfel& surfel) {
  const auto filter = kernels::surfel_filter(view, surfel, true);
  if (!filter) return {};
  const glm::vec3 o(view.camera_space(surfel.position)), s(view.camera_direction(surfel.tangent_s)),
      t(view.camera_direction(surfel.tangent_t));
  const auto eta = static_cast<float>(view.eta), sigma = static_cast<float>(surfel.sigma);
  const auto column = [&](const glm::vec3& a) {
    return eta / (o.z * o.z) * glm::vec2(a.x * o.z - a.z * o.x, a.z * o.y - a.y * o.z);
  };
  const glm::vec2 js = column(s), jt = column(t);
  const float d = js.x * jt.y - js.y * jt.x, squared = d * d;
  const float a = sigma * sigma + glm::dot(jt, jt) / squared, b = -2 * glm::dot(js, jt) / squared,
              c = sigma * sigma + glm::dot(js, js) / squared;
  const float p = a - c, q = a + c, root = sign(p) * std::sqrt(p * p + b * b);
  const float cosine = std::sqrt((root + p) / (2 * root)),
              sine = sign(b * p) * std::sqrt((root - p) / (2 * root));
  const double r0 = std::sqrt((q + root) / 2), r1 = std::sqrt((q - root) / 2);
  const glm::dmat2 axes{{r0 * cosine, r0 * sine}, {-r1 * sine, r1 * cosine}};
  const double deviation = kernels::deviation_error(axes, filter->axes);
  return {std::isfinite(deviation) ? deviation : kInfinity,
          relative(std::sqrt(filter->determinant), r0 * r1)};
}

std::vector<double> powers(double first, double last, double factor) {
  std::vector<double> values;
  const bool up = last > first;
  for (double x = first; up ? x < last * 1.001 : x > last * 0.999; x = up ? x * factor : x / factor)
    values.push_back(x);
  return values;
}

View usual_view(double) {
  return kernels::test_view();
}

// A surfel with everything usual but for one range.
template <class Set>
auto random_with(Set set) {
  return [=](const View& view, double x, std::mt19937& generator) {
    SurfelRanges ranges{.depth = {2, 20}, .cosine = {0.3, 1}, .spacing = {0.5, 5}, .sigma = {0.5, 1}};
    set(ranges, x);
    return kernels::random_surfel(view, ranges, generator);
  };
}

void set_range(double (&range)[2], double x) {
  range[0] = range[1] = x;
}

// The scene in other units: every length times `scale`.
View scaled_view(double scale) {
  View view = kernels::test_view();
  view.object_to_camera[3] = {glm::dvec3(view.object_to_camera[3]) * scale, 1};
  view.near_plane *= scale;
  view.far_plane *= scale;
  return view;
}

Surfel scaled_surfel(const View&, double scale, std::mt19937& generator) {
  Surfel surfel = random_with([](SurfelRanges&, double) {})(kernels::test_view(), 1, generator);
  surfel.position *= scale;
  surfel.tangent_s *= scale;
  surfel.tangent_t *= scale;
  return surfel;
}

// Its centre at `x` times the near distance from the eye.
Surfel near_eye(const View& view, double x, std::mt19937& generator) {
  return random_with([&](SurfelRanges& r, double) { set_range(r.depth, x * view.near_plane); })(view, x,
                                                                                                generator);
}

// `x` is 1 - cos(tilt): at 0 the surfel faces the eye, J is a multiple of I, and t = 0.
Surfel almost_facing(const View& view, double x, std::mt19937& generator) {
  return random_with([](SurfelRanges& r, double y) { set_range(r.cosine, 1 - y); })(view, x, generator);
}

// p = x q, and B < 0: tilted about a diagonal of s and t, which x turns by a little.
Surfel diagonal(const View& view, double x, std::mt19937&) {
  const double turn = 0.25 * std::numbers::pi - x, tilt = 1.0;
  const glm::dvec3 axis{std::cos(turn), std::sin(turn), 0};
  const auto turned = [&](const glm::dvec3& v) {  // Rodrigues
    return std::cos(tilt) * v + std::sin(tilt) * glm::cross(axis, v) +
           (1 - std::cos(tilt)) * glm::dot(axis, v) * axis;
  };
  const glm::dmat4 to_object = glm::inverse(view.object_to_camera);
  Surfel surfel;
  surfel.position = glm::dvec3(to_object * glm::dvec4(0, 0, 4, 1));
  surfel.tangent_s = glm::dmat3(to_object) * (0.01 * turned({0, 1, 0}));  // in this order it faces the eye
  surfel.tangent_t = glm::dmat3(to_object) * (0.01 * turned({1, 0, 0}));
  return surfel;
}

}  // namespace

std::vector<Splatter> splatters() {
  std::vector<Splatter> list{{"Appendix A as printed", [](const View& view, std::span<const Surfel> surfels) {
                                ExtremeErrors worst;
                                for (const Surfel& surfel : surfels)
                                  take_worst(worst, printed_errors(view, surfel));
                                return worst;
                              }}};
  for (const std::string_view program : {"paper", "normal", "facing"}) {
    list.push_back(by_program(program, Arithmetic::ieee, "ieee"));
    list.push_back(by_program(program, Arithmetic::nv20, "nv20"));
  }
  return list;
}

std::vector<ExtremeSweep> extreme_sweeps() {
  const double step = std::sqrt(10.0);
  return {
      {"cosine of a surfel seen edge-on", powers(1, 1e-7, step), usual_view,
       random_with([](SurfelRanges& r, double x) { set_range(r.cosine, x); })},
      {"spacing falling, pixels", powers(1, 1e-6, step), usual_view,
       random_with([](SurfelRanges& r, double x) { set_range(r.spacing, x); })},
      {"spacing rising, pixels", powers(1, 1e6, step), usual_view,
       random_with([](SurfelRanges& r, double x) { set_range(r.spacing, x); })},
      {"1 - cosine towards t = 0", powers(0.1, 1e-15, step), usual_view, almost_facing},
      {"turn towards p = 0 with B < 0, radians", powers(0.1, 1e-9, step), [](double) { return plain_view(); },
       diagonal},
      {"distance falling, near planes", powers(1000, 1.0001, step), usual_view, near_eye},
      {"distance rising, near planes", powers(10, 1e6, step), usual_view, near_eye},
      {"unit of length falling", powers(1, 1e-37, 10), scaled_view, scaled_surfel},
      {"unit of length rising", powers(1, 1e36, 10), scaled_view, scaled_surfel},
  };
}

ExtremeRow sweep_row(const ExtremeSweep& sweep, const Splatter& splatter, int surfels_a_value,
                     unsigned seed) {
  ExtremeRow row{sweep.name, splatter.name, sweep.values, {}, NAN, NAN, NAN};
  std::mt19937 generator(seed);
  for (const double value : sweep.values) {
    const View view = sweep.view(value);
    std::vector<Surfel> surfels;
    for (int i = 0; i < surfels_a_value; ++i) surfels.push_back(sweep.surfel(view, value, generator));
    const double error = splatter.errors(view, surfels).worst();
    row.errors.push_back(error);
    if (error > 0.01 && std::isnan(row.over_1)) row.over_1 = value;
    if (error > 0.1 && std::isnan(row.over_10)) row.over_10 = value;
    if (error > 1 && std::isnan(row.over_all)) row.over_all = value;
  }
  return row;
}

std::vector<Guard> guards() {
  return {
      {"o_z at the near plane or beyond",
       "paper",
       {{"max r1.w, r1.z, c3.z", ";"}, {"rcp r2.w, r1.w", "rcp r2.w, r1.z"}, {"r4.x, r1.w", "r4.x, r1.z"}},
       "the eye on or in a surfel"},
      {"floor of D^2",
       "paper",
       {{"add r8.w, r8.x, r8.y            ; S", ";"},
        {"mad r8.w, r8.w, r8.w, c7.x", ";"},
        {"mad r7.x, r8.w, c7.y, r7.x", ";"}},
       "D = 0: the eye in it, exactly edge-on, or of no size"},
      {"|p| never 0", "paper", {{"max r9.x, r9.x, c7.w", ";"}}, "t = 0: facing the eye"},
      {"second pivot of W", "facing", {{"max r7.y, r7.y, c6.x", ";"}}, "huge and edge-on"},
      {"second pivot of W", "normal", {{"max r7.y, r7.y, c6.x", ";"}}, "huge and edge-on"},
      {"corners at half the depth or beyond",
       "paper",
       {{"mul r4.x, r2.z, r2.z", ";"},
        {"mad r4.x, r3.z, r3.z, r4.x", ";"},
        {"mul r4.x, r4.x, r7.z", ";"},
        {"rsq r4.x, r4.x", ";"},
        {"mul r4.x, r4.x, r1.w", ";"},
        {"mul r4.x, r4.x, c7.z", ";"},
        {"min r4.x, r4.x, c3.w", ";"},
        {"mul r0.xy, r0, r4.x", ";"}},
       "corners past the eye"},
      {"corners at half the depth or beyond",
       "facing",
       {{"mul r10.y, r1.w, r3.w\n",
         "mul r10.z, r1.w, r9.z\nmul r10.z, r10.z, c6.y\nmax r10.x, r10.x, r10.z\nmul r10.y, r1.w, r3.w\n"}},
       "corners past the eye"},
  };
}

namespace {

isa::Program edited(std::string_view file, std::span<const std::pair<std::string, std::string>> edits) {
  ShaderText text = kernels::shader_text(file);
  for (const auto& [from, to] : edits) {
    const auto at = text.text.find(from);
    if (at == std::string::npos) throw ModelError(fmt::format("{} has no \"{}\"", text.name, from));
    text.text.replace(at, from.size(), to);
  }
  return load_program(text);
}

// How far the quad reaches from the centre in the window, in frames' widths, over what lies before the near
// plane.
double reach(const View& view, const Surfel& surfel, const QuadOutput& quad) {
  const auto corners = kernels::camera_space(view, surfel, quad);
  const glm::dvec2 center = view.window(view.camera_space(surfel.position));
  double farthest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    glm::dvec3 a = corners[i];
    const glm::dvec3& b = corners[(i + 1) % 4];
    if (a.z < view.near_plane) {
      if (b.z < view.near_plane) continue;
      a = glm::mix(a, b, (view.near_plane - a.z) / (b.z - a.z));
    }
    farthest = std::max(farthest, glm::distance(view.window(a), center));
    if (b.z < view.near_plane) {
      const glm::dvec3 cut = glm::mix(a, b, (view.near_plane - a.z) / (b.z - a.z));
      farthest = std::max(farthest, glm::distance(view.window(cut), center));
    }
  }
  return farthest / view.width;
}

GuardRow::Counts count(const View& view, std::span<const Surfel> surfels, std::span<const QuadOutput> quads) {
  GuardRow::Counts counts;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    if (!is_finite(quads[i])) {
      ++counts.not_finite;
      continue;
    }
    const auto filter = kernels::surfel_filter(view, surfels[i], true);
    if (!filter) continue;
    counts.off += !(errors_of(view, surfels[i], quads[i]).worst() < 0.1);
    double exact = 0;  // reach of the exact filter's parallelogram under the affine map
    for (const double y : {-1.0, 1.0}) {
      const glm::dvec2 corner =
          filter->jacobian * (filter->axes * glm::dvec2(std::sqrt(2.0), y * std::sqrt(2.0)));
      exact = std::max(exact, glm::length(corner) / view.width);
    }
    counts.too_wide += exact < 0.5 && reach(view, surfels[i], quads[i]) > 1;
  }
  return counts;
}

// Of every kind: usual, edge-on, huge, tiny, facing, with the eye in it, and of no size, which the short
// programs do not promise anything of.
std::vector<Surfel> all_kinds(const View& view, int each, unsigned seed, bool no_size) {
  std::mt19937 generator(seed);
  std::vector<Surfel> surfels;
  const auto add = [&](const SurfelRanges& ranges, auto change) {
    for (int i = 0; i < each; ++i) {
      Surfel surfel = kernels::random_surfel(view, ranges, generator);
      change(surfel);
      surfels.push_back(surfel);
    }
  };
  const auto keep = [](Surfel&) {};
  const glm::dvec3 eye = glm::inverse(view.object_to_camera) * glm::dvec4(0, 0, 0, 1);
  add({}, keep);
  add({.cosine = {1e-7, 1e-3}}, keep);
  add({.cosine = {1e-7, 1e-3}, .spacing = {1e4, 1e6}}, keep);
  add({.spacing = {1e-6, 1e-2}}, keep);
  add({.cosine = {1, 1}}, keep);
  add({}, [&](Surfel& s) { s.position = eye; });
  if (no_size) add({}, [&](Surfel& s) { s.tangent_s = s.tangent_t = {}; });
  // Facing exactly, where binary32 has no rounding: along the camera's axis.
  add({}, [&](Surfel& s) {
    const glm::dmat4 to_object = glm::inverse(view.object_to_camera);
    s.position = glm::dvec3(to_object * glm::dvec4(0, 0, 4, 1));
    s.tangent_s = glm::dmat3(to_object) * glm::dvec3(0.01, 0, 0);
    s.tangent_t = glm::dmat3(to_object) * glm::dvec3(0, 0.01, 0);
  });
  return surfels;
}

}  // namespace

GuardRow guard_row(const Guard& guard, Arithmetic arithmetic, int surfels, unsigned seed) {
  const kernels::SplatProgram& program = kernels::ewa_program(guard.program);
  isa::Program with = kernels::load_program(program.file), without = edited(program.file, guard.without);
  const bool put_in = isa::slot_count(without) > isa::slot_count(with);
  if (put_in) std::swap(with, without);
  GuardRow row{guard, isa::slot_count(with) - isa::slot_count(without), {}, {}};
  const View view = plain_view();
  const std::vector<Surfel> kinds = all_kinds(view, surfels, seed, guard.program == "paper");
  std::vector<Vec4> constants = program.constants(view, kernels::kCutoff, 0);
  if (put_in) constants[6][1] = 0.5f;
  row.with = count(view, kinds, kernels::run_quads(with, program.fields, arithmetic, constants, kinds));
  row.without = count(view, kinds, kernels::run_quads(without, program.fields, arithmetic, constants, kinds));
  return row;
}

}  // namespace splatscope::studies
