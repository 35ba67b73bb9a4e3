#include "studies/report/block_diagram.h"

#include <gtest/gtest.h>

#include <regex>

namespace splatscope::studies {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

sim::UnitBooks books(std::string name, sim::Cycle busy) {
  return {.name = std::move(name),
          .busy = busy,
          .starved = 90 - busy,
          .blocked = 7,
          .idle = 3,
          .blocked_by = {{"setup", 7}}};
}

sim::Result result() {
  sim::Result made;
  made.cycles = 100;
  for (const char* name : {"host", "agp", "command", "vertex_fetch", "primitive", "setup", "raster",
                           "memory0", "memory1", "unheard_of", "<odd>"}) {
    made.units.push_back(books(name, 50));
  }
  for (int i = 0; i < 6; ++i) made.units.push_back(books("vertex" + std::to_string(i), 40));
  made.channels = {{"host", "command", 3},
                   {"vertex_fetch", "vertex5", 12},
                   {"vertex_fetch", "memory0", 5},
                   {"vertex_fetch", "memory1", 6},
                   {"vertex_fetch", "primitive", 7}};
  return made;
}

TEST(BlockDiagram, ShowsEachUnitWithItsSharesAndEachChannel) {
  const std::string svg = block_diagram(result());
  EXPECT_EQ(17u, count(svg, "class=\"box\""));
  for (const char* share : {"busy", "starved", "blocked", "idle"})
    EXPECT_EQ(17u, count(svg, std::string("<rect class=\"") + share + "\""));
  EXPECT_EQ(
      1u,
      count(svg, "raster: busy 50.0 %, starved 40.0 %, blocked 7.0 %, idle 3.0 %; blocked by setup 7.0 %"));
  EXPECT_EQ(1u, count(svg, "vertex_fetch to vertex5: 12 items"));
  EXPECT_EQ(1u, count(svg, "vertex_fetch to memory: 11 requests")) << "one line for both channels";
  EXPECT_EQ(1u, count(svg, "&lt;odd&gt;: busy"));
}

// However many pass the pipeline on its left.
TEST(BlockDiagram, WaysAreInside) {
  sim::Result many = result();
  for (int i = 6; i < 16; ++i) many.units.push_back(books("vertex" + std::to_string(i), 40));
  for (int i = 0; i < 16; ++i) many.channels.push_back({"vertex" + std::to_string(i), "raster", 1});
  const std::string svg = block_diagram(many);
  const std::regex past(R"re(d="M[\d.]+ [\d.]+H(-?[\d.]+)V)re");
  std::size_t ways = 0;
  for (std::sregex_iterator it(svg.begin(), svg.end(), past), end; it != end; ++it, ++ways)
    EXPECT_GT(std::stod((*it)[1]), 0);
  EXPECT_GE(ways, 16u);
}

// The bar of a unit is as long as its box allows, whatever the shares; nothing lies over anything else.
TEST(BlockDiagram, BoxesAreApartAndInside) {
  const std::string svg = block_diagram(result());
  struct Rectangle {
    double x, y, width, height;
  };
  std::vector<Rectangle> boxes;
  const std::regex box(R"re(class="box" x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)")re");
  for (std::sregex_iterator it(svg.begin(), svg.end(), box), end; it != end; ++it)
    boxes.push_back({std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3]), std::stod((*it)[4])});
  std::smatch view;
  ASSERT_TRUE(std::regex_search(svg, view, std::regex(R"re(viewBox="0 0 ([\d.]+) ([\d.]+)")re")));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Rectangle& a = boxes[i];
    EXPECT_LE(a.x + a.width, std::stod(view[1]));
    EXPECT_LE(a.y + a.height, std::stod(view[2]));
    for (std::size_t k = 0; k < i; ++k) {
      const Rectangle& b = boxes[k];
      const bool apart =
          a.x >= b.x + b.width || b.x >= a.x + a.width || a.y >= b.y + b.height || b.y >= a.y + a.height;
      EXPECT_TRUE(apart) << i << " and " << k;
    }
  }
}

}  // namespace
}  // namespace splatscope::studies
