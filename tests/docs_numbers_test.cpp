#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "program.h"

// The numbers of the documentation are what the program finds: sections that docs/update writes, made again.
// Not here: times of the host (fidelity, software_splatting, volumes' head), what takes minutes (exploration
// and precision, of which tests in studies/ make lines again), and pictures of real models, which tests do
// not fetch (picture_quality).
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
  const std::string begin = "<!-- " + section.name + ": written by docs/update -->\n```\n";
  const auto at = page.find(begin);
  if (at == std::string::npos) return "no section " + section.name;
  return page.substr(at + begin.size(), page.find("```", at + begin.size()) - at - begin.size());
}

class DocumentedNumbers : public testing::TestWithParam<Section> {};

TEST_P(DocumentedNumbers, are_what_the_program_finds) {
  const ScratchFolder folder;
  std::vector<std::string> arguments = GetParam().command;
  arguments.insert(arguments.end(), {"--quiet", "--out", folder.path().string()});
  const Outcome outcome = run_program(arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  std::istringstream lines(outcome.out);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    line.resize(line.find_last_not_of(' ') + 1);
    if (line.find("report.html") == std::string::npos) found += line + "\n";
  }
  while (found.ends_with("\n\n")) found.pop_back();
  EXPECT_EQ(section_text(GetParam()), found) << GetParam().page << ": run docs/update";
}

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
                    Section{
                        "docs/volumes.md",
                        "figures",
                        {"reproduce", "zwicker-fig9", "zwicker-fig13", "zwicker-fig14", "zwicker-fig15"}}));

}  // namespace
}  // namespace splatscope::tests
