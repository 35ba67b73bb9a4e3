#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "program.h"

// The numbers of the documentation are what the program finds: sections that docs/update writes, made again.
// Not here: times of the host (fidelity, software_splatting, volumes' head), what takes minutes (exploration
// and precision, of which tests in studies/ make lines again), and pictures of real models, which tests do
// not fetch (picture_quality, real volumes).
namespace splatscope::tests {
namespace {

struct Section {
  std::string page, name;
  std::vector<std::string> command;
};

void PrintTo(const Section& section, std::ostream* out) {
  *out << section.page << ", " << section.name;
}

std::string section_text(const Section& section) {
  const std::string page = text_of(std::string(SPLATSCOPE_SOURCE) + "/" + section.page);
  const std::string begin = "<!-- " + section.name + ": written by docs/update -->\n";
  const auto at = page.find(begin);
  if (at == std::string::npos) return "no section " + section.name;
  return page.substr(at + begin.size(), page.find("<!-- end -->", at) - at - begin.size());
}

// The lines of a section, or of what a command prints, that are the same on every computer.
std::string lasting_lines(const std::string& text) {
  std::istringstream lines(text);
  std::string lasting;
  for (std::string line; std::getline(lines, line);) {
    line.resize(line.find_last_not_of(' ') + 1);
    if (!line.empty() && line != "```" && line.find("report.html") == std::string::npos &&
        line.find("on this host") == std::string::npos)
      lasting += line + "\n";
  }
  return lasting;
}

class DocumentedNumbers : public testing::TestWithParam<Section> {};

TEST_P(DocumentedNumbers, AreWhatTheProgramFinds) {
  const ScratchFolder folder;
  std::vector<std::string> arguments = GetParam().command;
  arguments.insert(arguments.end(), {"--quiet", "--out", folder.path().string()});
  const Outcome outcome = run_program(arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(lasting_lines(section_text(GetParam())), lasting_lines(outcome.out))
      << GetParam().page << ": run docs/update";
}

// A line of the table is a machine, what is set, and the frames a second of two scenes, of which the first is
// made again.
class DocumentedSensitivity : public testing::TestWithParam<std::string> {};

TEST_P(DocumentedSensitivity, IsWhatTheProgramFinds) {
  std::istringstream lines(section_text({"docs/table1.md", "sensitivity", {}}));
  const ScratchFolder folder;
  int compared = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::string bar, machine, change, no_ewa;
    cells >> bar >> machine >> bar >> change >> bar >> no_ewa;
    if (machine != GetParam()) continue;
    std::vector<std::string> arguments{"run",   "checkerboard-no-ewa", "--machine", machine,
                                       "--out", folder.path().string()};
    if (change != "nothing") arguments.insert(arguments.end(), {"--set", change});
    const Outcome run = run_program(arguments);
    ASSERT_EQ(run.status, 0) << run.error;
    const auto results = results_in(folder.path());
    EXPECT_EQ(no_ewa, fmt::format("{:.1f}", results["frames"][0]["frames_per_second"].get<double>())) << line;
    ++compared;
  }
  EXPECT_GE(compared, 5);
}

INSTANTIATE_TEST_SUITE_P(Machines, DocumentedSensitivity, testing::Values("geforce4-ti4400", "radeon-8500"));

INSTANTIATE_TEST_SUITE_P(
    Sections, DocumentedNumbers,
    testing::Values(Section{"README.md", "table 1", {"reproduce", "table1"}},
                    Section{"docs/table2.md", "table 2", {"reproduce", "table2"}},
                    Section{"docs/vertex_data.md", "vertex data", {"study", "vertex-data"}},
                    Section{"docs/depth_offset.md", "fig3", {"reproduce", "fig3"}},
                    Section{"docs/depth_offset.md", "fig4 fig5", {"reproduce", "fig4", "fig5"}},
                    Section{"docs/normalisation.md", "fig10", {"reproduce", "fig10"}},
                    Section{"docs/alpha_texture.md", "alpha texture", {"study", "alpha-texture"}},
                    Section{"docs/hierarchy.md", "hierarchy", {"study", "hierarchy"}},
                    Section{"docs/extremes.md", "extremes", {"study", "extremes"}},
                    Section{"docs/volumes.md", "ripple", {"study", "volume-ripple"}},
                    Section{"docs/volumes_on_the_machine.md", "volumes", {"reproduce", "zwicker-fig16"}},
                    Section{
                        "docs/volumes.md",
                        "figures",
                        {"reproduce", "zwicker-fig9", "zwicker-fig13", "zwicker-fig14", "zwicker-fig15"}}));

}  // namespace
}  // namespace splatscope::tests
