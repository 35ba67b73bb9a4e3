#include "studies/reproduction/zwicker_surfaces.h"

#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include <cmath>
#include <span>

#include "kernels/reference/fast_splatting.h"
#include "studies/measure.h"
#include "traces/median.h"

namespace splatscope::studies {
namespace {

constexpr int kLayers = 8;
constexpr int kSizes[] = {256, 512};

struct PublishedModel {
  SurfaceModel (*make)(int points, int size);
  int points;
  double fps[2];  // at kSizes
};
constexpr PublishedModel kPublished[] = {{head_model, 429075, {1.3, 0.7}},
                                         {terrain_model, 4782011, {0.2, 0.1}},
                                         {helicopter_model, 987552, {0.6, 0.3}}};

kernels::LayeredSettings settings_of(const SurfaceModel& model, int layers) {
  return {.same_surface = 4 * model.spacing, .layers = layers, .background = {0.08, 0.09, 0.12}};
}

nlohmann::ordered_json json_of(const std::vector<SurfaceRow>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const SurfaceRow& row : rows) {
    const auto points = static_cast<double>(row.points);
    list.push_back({{"model", row.model},
                    {"stand_in", row.stand_in},
                    {"points", row.points},
                    {"resolution", row.size},
                    {"fps_published", row.published_fps},
                    {"fps_layered", 1 / row.layered_seconds},
                    {"splats_per_second_layered", points / row.layered_seconds},
                    {"fps_single", 1 / row.single_seconds},
                    {"splats_per_second_single", points / row.single_seconds}});
  }
  return list;
}

void add_table(Findings& findings, const std::vector<SurfaceRow>& rows) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const SurfaceRow& row : rows) {
    const auto points = static_cast<double>(row.points);
    cells.push_back({row.model, row.stand_in, fmt::format("{}", row.points), fmt::format("{}", row.size),
                     fmt::format("{:.1f}", row.published_fps), fmt::format("{:.2f}", 1 / row.layered_seconds),
                     fmt::format("{:.1f}", 1 / row.single_seconds),
                     fmt::format("{:.2f}", points / row.single_seconds / 1e6)});
  }
  findings.table(
      "Published: unoptimised software on a 1.1 GHz Athlon. Layered: the same algorithm in double precision "
      "with eight layers; single: the opaque renderer at speed. Both on this host.",
      {{"model"},
       {"stand-in"},
       {"points", number},
       {"size", number},
       {"published fps", number},
       {"layered fps", number},
       {"single fps", number},
       {"million splats a second, single", number}},
      cells);
}

}  // namespace

kernels::LayeredPicture draw_layered(const SurfaceModel& model, int layers) {
  kernels::LayeredSettings settings = settings_of(model, layers);
  const auto draw = [&] {
    return kernels::layered_splatting(model.view, model.surfels, model.opacities, settings);
  };
  std::vector<double> weights = draw().weights;
  std::erase(weights, 0.0);
  settings.whole_weight = 0.9 * traces::median(std::span(weights));
  return draw();
}

std::vector<SurfaceRow> surface_rows(double share, int repeats, const Progress& progress) {
  std::vector<SurfaceRow> rows;
  for (const PublishedModel& published : kPublished) {
    const auto points = static_cast<int>(std::lround(share * published.points));
    SurfaceModel model = published.make(points, kSizes[0]);
    kernels::FastSplatting fast(model.surfels);
    for (std::size_t i = 0; i < std::size(kSizes); ++i) {
      model.view.eta *= static_cast<double>(kSizes[i]) / model.view.width;
      model.view.width = model.view.height = kSizes[i];
      SurfaceRow row{model.name, model.stand_in, model.surfels.size(), kSizes[i], published.fps[i], 0, 0};
      row.layered_seconds = median_seconds(repeats, [&] {
        kernels::layered_splatting(model.view, model.surfels, model.opacities, settings_of(model, kLayers));
      });
      row.single_seconds = median_seconds(
          repeats, [&] { fast.draw(model.view, {.depth_offset = model.spacing, .cull_back_faces = true}); });
      rows.push_back(std::move(row));
      tell(progress, rows.size(), std::size(kPublished) * std::size(kSizes));
    }
  }
  return rows;
}

void reproduce_zwicker_figure17(Findings& findings, const Progress& progress) {
  std::vector<Findings::Picture> pictures;
  auto list = nlohmann::ordered_json::array();
  constexpr const char* kParts[] = {"a", "b", "c"};
  std::string text;
  for (const PublishedModel& published : kPublished) {
    const SurfaceModel model = published.make(published.points, 512);
    const kernels::LayeredPicture picture = draw_layered(model, kLayers);
    const kernels::LayerOutcomes& outcomes = picture.outcomes;
    const char* part = kParts[pictures.size()];
    const auto all =
        static_cast<double>(outcomes.added + outcomes.founded + outcomes.replaced + outcomes.dropped);
    const auto percent = [&](std::size_t count) { return 100 * static_cast<double>(count) / all; };
    text += fmt::format(
        "zwicker-fig17{} {:<12} {:>7} surfels; of {:.0f} M contributions {:.1f} % added to a layer, {:.1f} % "
        "founded one, {:.2f} % replaced the furthest, {:.2f} % dropped\n",
        part, model.name, model.surfels.size(), all / 1e6, percent(outcomes.added), percent(outcomes.founded),
        percent(outcomes.replaced), percent(outcomes.dropped));
    pictures.push_back({fmt::format("zwicker-fig17{}", part),
                        fmt::format("{}: {}, {} surfels", model.name, model.stand_in, model.surfels.size()),
                        opaque_image(picture.width, picture.height, picture.pixels)});
    list.push_back({{"model", model.name},
                    {"stand_in", model.stand_in},
                    {"surfels", model.surfels.size()},
                    {"layers", kLayers},
                    {"added", outcomes.added},
                    {"founded", outcomes.founded},
                    {"replaced", outcomes.replaced},
                    {"dropped", outcomes.dropped}});
    tell(progress, pictures.size(), std::size(kPublished));
  }
  findings.report().heading("Zwicker 2002, Fig. 17: EWA surface splatting");
  findings.text(text);
  findings.pictures(pictures);
  findings.result("zwicker_fig17", list);
}

void reproduce_zwicker_table1(Findings& findings, const Progress& progress) {
  const std::vector<SurfaceRow> rows = surface_rows(1, 3, progress);
  findings.report().heading("Zwicker 2002, Table I: software surface splatting");
  findings.text(
      fmt::format("zwicker-table1: software on {} threads of this host; published: a 1.1 GHz Athlon\n",
                  oneapi::tbb::this_task_arena::max_concurrency()));
  add_table(findings, rows);
  findings.result("zwicker_table1", json_of(rows));
}

}  // namespace splatscope::studies
