#include "studies/reproduction.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "model/error.h"
#include "studies/report.h"
#include "studies/table1.h"
#include "traces/output_files.h"

namespace splatscope::studies {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Table1& table) {
  Json rows = Json::array();
  for (const Table1Row& row : table.rows) {
    rows.push_back({{"algorithm", row.algorithm},
                    {"machine", row.machine},
                    {"vs1", row.visibility_slots},
                    {"vs2", row.splat_slots},
                    {"fps_published", row.published_fps},
                    {"fps_simulated", row.simulated_fps},
                    {"error", row.error()},
                    {"role", row.fitted ? "fitted" : "predicted"},
                    {"fitted_parameter", row.fitted_by},
                    {"bottleneck", row.bottleneck},
                    {"bottleneck_busy_share", row.bottleneck_share},
                    {"psnr_decibels", row.psnr},
                    {"cycles_per_host_second", row.cycles_per_host_second}});
  }
  return rows;
}

void add_to(Report& report, const Table1& table) {
  using enum Report::Align;
  report.heading("Table 1: frame rates at 512 x 512");
  std::vector<std::vector<std::string>> rows;
  for (const Table1Row& row : table.rows) {
    rows.push_back({row.algorithm, row.machine, fmt::format("{}", row.visibility_slots),
                    fmt::format("{}", row.splat_slots), fmt::format("{:.1f}", row.published_fps),
                    fmt::format("{:.2f}", row.simulated_fps), fmt::format("{:+.1f} %", 100 * row.error()),
                    row.fitted ? "fitted: " + row.fitted_by : "predicted",
                    fmt::format("{} ({:.0f} % busy)", row.bottleneck, 100 * row.bottleneck_share),
                    fmt::format("{:.1f}", row.psnr)});
  }
  report.table(
      "64k-surfel checkerboard plane. VS1, VS2: instruction slots of the two passes, counted from the "
      "programs "
      "that ran. A row is fitted where a parameter of the machine was fitted to that very figure, else "
      "predicted.",
      {{"algorithm"},
       {"machine"},
       {"VS1", number},
       {"VS2", number},
       {"published fps", number},
       {"simulated fps", number},
       {"error", number},
       {"role"},
       {"bottleneck"},
       {"PSNR, dB", number}},
      rows);
  report.paragraph(
      "PSNR is against the double-precision sums of Eq. 8, normalised per pixel, over the pixels that the "
      "plane covers. The paper gives neither the camera nor the size of the squares: both are a "
      "reconstruction, as are the programs, of which it prints no listing.");
  report.heading("Fig. 11: the three algorithms");
  const std::string_view captions[] = {"a) without EWA filtering", "b) EWA, normalised per pixel",
                                       "c) EWA, normalised per surfel"};
  std::vector<Report::Picture> pictures;
  for (std::size_t i = 0; i < table.pictures.size(); ++i) {
    pictures.push_back({table.pictures[i].algorithm, std::string(captions[i]), table.pictures[i].image});
  }
  report.pictures(pictures);
}

}  // namespace

std::vector<std::string_view> reproduction_names() {
  return {"table1"};
}

void reproduce(const std::vector<std::string>& names, const std::filesystem::path& folder,
               const Progress& progress) {
  const std::vector<std::string_view> known = reproduction_names();
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) == known.end()) {
      throw UserError("reproduce", 0, fmt::format("unknown result \"{}\", expected table1", name));
    }
  }
  traces::prepare_output_folder(folder);

  const auto start = std::chrono::steady_clock::now();
  const Table1 table = reproduce_table1(progress);
  fmt::print("{}", text_of(table));
  for (const Table1Picture& picture : table.pictures) {
    write_exr(picture.image, folder / fmt::format("fig11-{}.exr", picture.algorithm));
    write_png(picture.image, folder / fmt::format("fig11-{}.png", picture.algorithm));
  }
  Report report("splatscope: Object Space EWA Surface Splatting, 2002",
                "The published results of Ren, Pfister and Zwicker on the simulated machines of 2002.");
  add_to(report, table);
  report.write(folder / "report.html");

  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Json results = {{"table1", json_of(table)}, {"host", {{"seconds", seconds}}}};
  traces::write_file(folder / "results.json", results.dump(1) + "\n");
  fmt::print(
      "{:.1f} s, the last frame at {:.1f} M simulated cycles a second; results.json, report.html and "
      "pictures in {}\n",
      seconds, table.rows.back().cycles_per_host_second / 1e6, folder.string());
}

}  // namespace splatscope::studies
