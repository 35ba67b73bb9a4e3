#include "studies/alpha_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "kernels/object_space_ewa/alpha_texture.h"
#include "studies/reference_comparison.h"
#include "studies/run.h"

namespace splatscope::studies {
namespace {

constexpr double kCutoffs[] = {0.25, 0.5, 1, 2, 4, 8};
constexpr double kParts[] = {0.0625, 0.125, 0.25, 0.5, 1, 2};  // of Eq. 16's size

// The plane of Fig. 11 at a quarter of its size. Uncut Gaussians sum to 2 on it: one gamma for every cutoff.
traces::Scene plane(double cutoff, bool circle) {
  return traces::parse_scene(
      fmt::format(
          "[surfels]\ncolumns = 128\nrows = 128\n[frame]\nwidth = 256\nheight = 256\n[camera]\n"
          "eye = [0, 35, 112.5]\ntarget = [0, 0, 15]\n"
          "[splatting]\nalgorithm = \"ewa-per-pixel\"\ngamma = 0.45\ncutoff = {}\ncircular_cutoff = {}\n",
          cutoff, circle),
      "plane.toml");
}

std::vector<int> lengths_for(double cutoff) {
  std::vector<int> lengths;
  for (const double part : kParts)
    lengths.push_back(static_cast<int>(std::lround(part * kernels::optimal_length(cutoff))));
  return lengths;
}

// The rows of one cutoff by both shapes: the texture holds the same, the pictures differ.
struct Shapes {
  std::vector<TextureRow> circle, square;
};

std::string text_of(const std::vector<Shapes>& all) {
  std::string text =
      fmt::format("{:>5} {:>6} {:>8} {:>7} {:>7} {:>5} {:>9}  {:>15}  {:>15}\n", "c", "length", "of Eq.16",
                  "texels", "values", "step", "repeated", "circle: float, 8", "square: float, 8");
  for (const Shapes& shapes : all) {
    for (std::size_t i = 0; i < shapes.circle.size(); ++i) {
      const TextureRow &circle = shapes.circle[i], &square = shapes.square[i];
      text += fmt::format(
          "{:>5} {:>6} {:>8.3f} {:>7} {:>7} {:>5} {:>8.1f}%  {:>6.1f} {:>5.1f} dB  {:>6.1f} {:>5.1f} dB\n",
          circle.cutoff, circle.length, circle.of_optimal, circle.length * circle.length, circle.values,
          circle.largest_step, 100 * circle.repeated, circle.psnr_float, circle.psnr, square.psnr_float,
          square.psnr);
    }
  }
  return text;
}

nlohmann::ordered_json json_of(const std::vector<Shapes>& all) {
  auto list = nlohmann::ordered_json::array();
  for (const Shapes& shapes : all) {
    for (std::size_t i = 0; i < shapes.circle.size(); ++i) {
      const TextureRow &circle = shapes.circle[i], &square = shapes.square[i];
      const auto decibels = [](const TextureRow& row) {
        return nlohmann::ordered_json{{"psnr_float_frame", row.psnr_float}, {"psnr", row.psnr}};
      };
      list.push_back({{"cutoff", circle.cutoff},
                      {"length", circle.length},
                      {"of_optimal", circle.of_optimal},
                      {"values", circle.values},
                      {"largest_step", circle.largest_step},
                      {"repeated", circle.repeated},
                      {"circle", decibels(circle)},
                      {"square", decibels(square)}});
    }
  }
  return list;
}

// A curve of the rows over their part of Eq. 16's size.
Plot::Series curve(const std::string& name, const std::vector<TextureRow>& rows,
                   double (*value)(const TextureRow&)) {
  Plot::Series series{name, {}, {}};
  for (const TextureRow& row : rows) {
    series.x.push_back(row.of_optimal);
    series.y.push_back(value(row));
  }
  return series;
}

Plot size_plot() {
  Plot plot{.title = "Size of the alpha texture", .x_label = "c", .y_label = "texels along an edge"};
  plot.log_x = plot.log_y = true;
  plot.series = {{"Eq. 16", {}, {}}, {"least without a value left out", {}, {}, false}};
  for (const double cutoff : kCutoffs) {
    plot.series[0].x.push_back(cutoff);
    plot.series[0].y.push_back(kernels::optimal_length(cutoff));
    plot.series[1].x.push_back(cutoff);
    plot.series[1].y.push_back(least_length(cutoff));
  }
  return plot;
}

Plot relative_plot(const std::string& title, const std::string& y_label) {
  Plot plot{.title = title, .x_label = "length, of that of Eq. 16", .y_label = y_label};
  plot.log_x = true;
  return plot;
}

}  // namespace

TextureRow describe_texture(double cutoff, int length) {
  TextureRow row{.cutoff = cutoff,
                 .length = length,
                 .of_optimal = static_cast<double>(length) / kernels::optimal_length(cutoff)};
  const Texture texture = kernels::alpha_texture(cutoff, length, kernels::CutoffShape::square);
  std::set<std::uint8_t> values;
  std::size_t pairs = 0, repeated = 0;
  const auto n = static_cast<std::size_t>(length);
  for (std::size_t y = 0; y < n; ++y) {
    for (std::size_t x = 0; x < n; ++x) {
      const int here = texture.texels[y * n + x];
      values.insert(static_cast<std::uint8_t>(here));
      if (x == 0) continue;
      const int step = std::abs(here - texture.texels[y * n + x - 1]);
      row.largest_step = std::max(row.largest_step, step);
      ++pairs;
      repeated += step == 0;
    }
  }
  row.values = static_cast<int>(values.size());
  row.repeated = static_cast<double>(repeated) / static_cast<double>(pairs);
  return row;
}

int least_length(double cutoff) {
  const auto leaves_out = [&](int length) {
    const Texture texture = kernels::alpha_texture(cutoff, length, kernels::CutoffShape::square);
    const auto n = static_cast<std::size_t>(length);
    for (std::size_t i = 1; i < n * n; ++i)
      if (i % n != 0 && std::abs(texture.texels[i] - texture.texels[i - 1]) > 1) return true;
    return false;
  };
  int length = kernels::optimal_length(cutoff);  // leaves none out: Eq. 16
  while (length > 2 && !leaves_out(length - 1)) --length;
  return length;
}

std::vector<TextureRow> texture_rows(const traces::Scene& scene, std::span<const int> lengths,
                                     const Machine& machine) {
  const Machine exact = with_frame(machine, FrameFormat::float32);
  const kernels::SplatSums reference = single_surface_reference(scene);
  std::vector<TextureRow> rows;
  traces::Scene changed = scene;
  for (const int length : lengths) {
    changed.splatting.texture_length = length;
    TextureRow row = describe_texture(scene.splatting.cutoff, length);
    row.psnr_float = psnr(draw_frame(changed, exact), reference);
    row.psnr = psnr(draw_frame(changed, machine), reference);
    rows.push_back(row);
  }
  return rows;
}

void study_alpha_texture(Findings& findings, const Progress& progress) {
  const Machine machine = machine::load(machine::kGeForce4);
  findings.report().heading("The size of the alpha texture: Eq. 15 and 16");
  std::vector<Shapes> all;
  Plot repeated = relative_plot("Repeated texels", "neighbours that are the same, percent");
  Plot pictures = relative_plot("The picture, with a float frame buffer", "PSNR, dB");
  std::string sizes;
  for (const double cutoff : kCutoffs) {
    const std::vector<int> lengths = lengths_for(cutoff);
    all.push_back({texture_rows(plane(cutoff, true), lengths, machine),
                   texture_rows(plane(cutoff, false), lengths, machine)});
    const Shapes& shapes = all.back();
    repeated.series.push_back(curve(fmt::format("c = {}", cutoff), shapes.circle,
                                    [](const TextureRow& row) { return 100 * row.repeated; }));
    if (cutoff <= 1) {
      const auto decibels = [](const TextureRow& row) { return row.psnr_float; };
      pictures.series.push_back(curve(fmt::format("c = {}, circle", cutoff), shapes.circle, decibels));
      pictures.series.push_back(curve(fmt::format("c = {}, square", cutoff), shapes.square, decibels));
    }
    sizes += fmt::format("c = {}: Eq. 16 gives {}, the least without a value left out is {}\n", cutoff,
                         kernels::optimal_length(cutoff), least_length(cutoff));
    tell(progress, all.size(), std::size(kCutoffs));
  }
  findings.text(sizes + text_of(all));
  findings.plot("alpha-texture-size", size_plot());
  findings.plot("alpha-texture-repeated", repeated);
  findings.plot("alpha-texture-psnr", pictures);
  findings.result("alpha_texture", json_of(all));
}

}  // namespace splatscope::studies
