#include "studies/study.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/testing/scratch_folder.h"

namespace splatscope::studies {
namespace {

// What goes to standard output meanwhile.
template <class Run>
std::string said_by(const Run& run) {
  ::testing::internal::CaptureStdout();
  run();
  return ::testing::internal::GetCapturedStdout();
}

TEST(Study, AProgressHasParts) {
  double told = 0;
  const Progress whole = [&](double fraction) { told = fraction; };
  part(whole, 0.25, 0.75)(0.5);
  EXPECT_EQ(told, 0.5);
  tell(part(whole, 0.5, 1), 1, 4);
  EXPECT_EQ(told, 0.625);
  EXPECT_FALSE(part({}, 0, 1)) << "nobody listens";
}

TEST(Study, EachIsAPartOfTheProgressOfAll) {
  const ScratchFolder folder;
  Findings findings(folder.path(), "two", "");
  const auto half = [](Findings& found, const Progress& progress) {
    found.say("run\n");
    progress(0.5);
  };
  const Study studies[] = {{"a", "", half}, {"b", "", half}};
  std::vector<double> told;
  const std::string said =
      said_by([&] { run_studies(studies, findings, [&](double fraction) { told.push_back(fraction); }); });
  EXPECT_EQ(told, (std::vector<double>{0.25, 0.75}));
  EXPECT_TRUE(said.starts_with("run\nrun\n")) << said;
  EXPECT_NE(said.find(" s; results.json and report.html in "), std::string::npos) << said;
}

TEST(Study, TablesHaveNumbersToTheRight) {
  const ScratchFolder folder;
  Findings findings(folder.path(), "table", "");
  EXPECT_EQ(said_by([&] {
              findings.table("", {{"name"}, {"count", Report::Align::number}, {"last"}},
                             {{"a", "1", "x"}, {"long name", "123456", ""}});
            }),
            "name        count  last\n"
            "a               1  x\n"
            "long name  123456\n");
}

// Every file that it wrote stands in the results, and what kinds there are is said.
TEST(Study, FindingsNameTheirFiles) {
  const ScratchFolder folder;
  const Image image(2, 2);
  const auto find = [&](const char* name, const auto& what) {
    Findings findings(folder / name, "", "");
    what(findings);
    const std::string said = said_by([&] { findings.write(1); });
    std::vector<std::string> files = nlohmann::json::parse(text_of(folder / name / "results.json"))["files"];
    for (const std::string& file : files) EXPECT_TRUE(std::filesystem::exists(folder / name / file)) << file;
    std::ranges::sort(files);
    return std::pair(files, said);
  };
  const auto [compared, of_compared] = find("compared", [&](Findings& findings) {
    findings.compare({{"c", "", image, image, image}});
  });
  EXPECT_EQ(compared,
            (std::vector<std::string>{"c.exr", "c.png", "difference-c.exr", "difference-c.png",
                                      "reference-c.exr", "reference-c.png", "report.html", "results.json"}));
  EXPECT_NE(of_compared.find("1.0 s; results.json, report.html and pictures in "), std::string::npos);
  const auto [plotted, of_plotted] = find("plotted", [](Findings& findings) {
    findings.plot("p", {.title = "p", .x_label = "x", .y_label = "y", .series = {{"s", {1, 2}, {1, 2}}}});
  });
  EXPECT_EQ(plotted, (std::vector<std::string>{"p.svg", "report.html", "results.json"}));
  EXPECT_NE(of_plotted.find(", report.html and pictures in "), std::string::npos) << of_plotted;
}

}  // namespace
}  // namespace splatscope::studies
