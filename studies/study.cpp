#include "studies/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iostream>

#include "model/error.h"
#include "studies/json_text.h"
#include "studies/measure.h"
#include "studies/report/configuration.h"
#include "studies/result_files.h"
#include "traces/output_files.h"

namespace splatscope::studies {

namespace {

constexpr const char* kFiles = "files";
constexpr std::array kAlways{"report.html", "results.json"};

// Before a file of this name is written: the first one takes the folder over. The pictures of a study stand
// in it as soon as they are drawn, for it may take an hour; results.json comes last, and says that all are
// there.
void announce(nlohmann::ordered_json& results, const std::filesystem::path& folder, const std::string& name) {
  if (!results.contains(kFiles)) remove_earlier_results(folder);
  results[kFiles].push_back(name);
}

void announce_picture(nlohmann::ordered_json& results, const std::filesystem::path& folder,
                      const std::string& name) {
  for (const char* kind : {".exr", ".png"}) announce(results, folder, name + kind);
}

}  // namespace

Progress part(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [=](double fraction) { progress(from + fraction * (to - from)); };
}

void tell(const Progress& progress, std::size_t done, std::size_t all) {
  if (progress) progress(static_cast<double>(done) / static_cast<double>(all));
}

Findings::Findings(std::filesystem::path folder, std::string_view title, std::string_view lead)
    : folder_(std::move(folder)), report_(title, lead), results_(nlohmann::ordered_json::object()) {
  for (const char* name : kAlways) const traces::OutputFile probe(folder_.path() / name);
}

void Findings::result(std::string_view key, nlohmann::ordered_json value) {
  results_[std::string(key)] = std::move(value);
}

void Findings::say(std::string_view text) {
  std::cout << text;  // a failure is told at the end, when all files are written
}

void Findings::text(std::string_view text) {
  say(text);
  report_.lines(text);
}

void Findings::table(std::string_view caption, const std::vector<Report::Column>& columns,
                     const std::vector<std::vector<std::string>>& rows) {
  report_.table(caption, columns, rows);
  std::vector<std::string> lines(rows.size() + 1);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto cell = [&](std::size_t line) -> const std::string& {
      return line == 0 ? columns[c].name : rows[line - 1][c];
    };
    std::size_t width = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) width = std::max(width, cell(i).size());
    const bool is_number = columns[c].align == Report::Align::number;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (c > 0) lines[i] += "  ";
      lines[i] += is_number ? fmt::format("{:>{}}", cell(i), width) : fmt::format("{:<{}}", cell(i), width);
    }
  }
  for (std::string& line : lines) say(line.erase(line.find_last_not_of(' ') + 1) + "\n");
}

void Findings::write_picture(const std::string& name, const Image& image) const {
  write_exr(image, folder_.path() / (name + ".exr"));
  write_png(image, folder_.path() / (name + ".png"));
}

void Findings::pictures(const std::vector<Picture>& pictures) {
  std::vector<Report::Picture> shown;
  for (const Picture& picture : pictures) {
    announce_picture(results_, folder_.path(), picture.name);
    write_picture(picture.name, picture.image);
    shown.push_back({picture.name, picture.caption, picture.image});
  }
  report_.pictures(shown);
}

void Findings::compare(const std::vector<Comparison>& comparisons) {
  std::vector<Report::Comparison> shown;
  for (const Comparison& c : comparisons) {
    for (const char* start : {"", "reference-", "difference-"})
      announce_picture(results_, folder_.path(), start + c.name);
    write_picture(c.name, c.simulated);
    write_picture("reference-" + c.name, c.reference);
    write_picture("difference-" + c.name, c.difference);
    shown.push_back({{c.name, c.caption, c.simulated}, c.reference, c.difference});
  }
  report_.comparisons(shown);
}

void Findings::plot(const std::string& name, const Plot& plot) {
  const std::string svg = add_plot(report_, plot);
  if (svg.empty()) return say(fmt::format("no {}.svg: the report says why\n", name));
  announce(results_, folder_.path(), name + ".svg");
  traces::write_file(folder_.path() / (name + ".svg"), svg);
}

void Findings::write(double host_seconds) {
  results_["host"] = {{"seconds", host_seconds}};
  for (const char* name : kAlways) announce(results_, folder_.path(), name);
  report_.heading("The machines");
  for (const std::string_view name : machine::built_in_names())
    add_configuration(report_, machine::load(name));
  report_.write(folder_.path() / "report.html");
  traces::write_file(folder_.path() / "results.json", json_text(results_, 1) + "\n");
  const bool pictures = std::ranges::any_of(results_["files"], [](const auto& name) {
    const std::string file = name;
    return file.ends_with(".png") || file.ends_with(".svg");
  });
  say(fmt::format("{:.1f} s; results.json{} in {}\n", host_seconds,
                  pictures ? ", report.html and pictures" : " and report.html", folder_.path().string()));
}

std::string names_of(std::span<const Study> studies) {
  std::string names;
  for (const Study& study : studies) names += fmt::format("{}{}", names.empty() ? "" : ", ", study.name);
  return names;
}

std::vector<Study> choose(std::span<const Study> studies, std::string_view command,
                          const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (std::ranges::find(studies, name, &Study::name) == studies.end()) {
      throw UserError(command, 0, fmt::format("unknown name \"{}\", expected {}", name, names_of(studies)));
    }
  }
  std::vector<Study> chosen;
  std::ranges::copy_if(studies, std::back_inserter(chosen), [&](const Study& study) {
    return names.empty() || std::ranges::find(names, study.name) != names.end();
  });
  return chosen;
}

void run_studies(std::span<const Study> studies, Findings& findings, const Progress& progress) {
  const auto start = HostClock::now();
  const auto count = static_cast<double>(studies.size());
  double done = 0;
  for (const Study& study : studies) {
    study.run(findings, part(progress, done / count, (done + 1) / count));
    ++done;
  }
  findings.write(seconds_since(start));
}

}  // namespace splatscope::studies
