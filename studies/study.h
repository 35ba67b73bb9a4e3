#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/image_io.h"
#include "studies/plot.h"
#include "studies/report.h"
#include "traces/output_files.h"

// What `reproduce` and `study` have in common: a list of studies, and one place for what they find.
namespace splatscope::studies {

using Progress = std::function<void(double)>;  // told the fraction done, from 0 to 1

// Part of a longer progress, from one fraction to another.
Progress part(const Progress& progress, double from, double to);

// Of `all` steps alike, `done` are done. Nothing where nobody listens.
void tell(const Progress& progress, std::size_t done, std::size_t all);

// What studies find: text for the terminal, figures for scripts (results.json), tables and pictures for
// people (report.html, PNG and EXR files), all in one folder.
class Findings {
 public:
  // Throws UserError where the folder cannot be made or written.
  Findings(std::filesystem::path folder, std::string_view title, std::string_view lead);

  Report& report() { return report_; }
  // Stands in results.json under `key`.
  void result(std::string_view key, nlohmann::ordered_json value);
  // Goes to standard output.
  void say(std::string_view text);
  // Goes to standard output and into the report, in lines as they are.
  void text(std::string_view text);
  // Goes to standard output, and under its caption into the report.
  void table(std::string_view caption, const std::vector<Report::Column>& columns,
             const std::vector<std::vector<std::string>>& rows);

  struct Picture {
    std::string name;  // of its files, without ending
    std::string caption;
    Image image;
  };
  // Written as name.png and name.exr, and put into the report side by side.
  void pictures(const std::vector<Picture>& pictures);

  struct Comparison {
    std::string name, caption;
    Image simulated, reference;
    Image difference;  // as difference_picture makes it
  };
  // Written as name.png, reference-name.png, difference-name.png and the same as .exr, and put into the
  // report with a slider between them.
  void compare(const std::vector<Comparison>& comparisons);
  // Written as name.svg, and put into the report.
  void plot(const std::string& name, const Plot& plot);

  // Writes report.html and results.json, which also holds the host's seconds.
  void write(double host_seconds);

 private:
  void write_picture(const std::string& name, const Image& image) const;

  traces::OutputFolder folder_;
  Report report_;
  nlohmann::ordered_json results_;
};

struct Study {
  std::string_view name;  // "table1"
  std::string_view what;  // a line for people
  void (*run)(Findings&, const Progress&);
};

// "table1, fig11".
std::string names_of(std::span<const Study> studies);

// The studies of the given names (none: all) in the order of the list. `command` is named in errors. Throws
// UserError for an unknown name.
std::vector<Study> choose(std::span<const Study> studies, std::string_view command,
                          const std::vector<std::string>& names);

// Runs the studies one after the other and writes what they found.
void run_studies(std::span<const Study> studies, Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
