#include "studies/report.h"

#include <gtest/gtest.h>

#include "model/error.h"

namespace splatscope::studies {
namespace {

bool holds(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(Report, EscapesWhateverItIsGiven) {
  Report report("a < b", "\"lead\" & more");
  report.heading("<h>");
  report.paragraph("<script>alert(1)</script>");
  report.table("<c>", {{"x<y", Report::Align::number}}, {{"<1>"}});
  const std::string html = report.html();
  EXPECT_FALSE(holds(html, "<script>alert"));
  EXPECT_FALSE(holds(html, "<1>"));
  EXPECT_TRUE(holds(html, "<title>a &lt; b</title>"));
  EXPECT_TRUE(holds(html, "&quot;lead&quot; &amp; more"));
  EXPECT_TRUE(holds(html, "<th scope=\"col\" class=\"number\">x&lt;y</th>"));
  EXPECT_TRUE(holds(html, "<td class=\"number\">&lt;1&gt;</td>"));
}

// The page says that it is UTF-8; names of files need not be.
TEST(Report, HoldsNoBytesThatAreNoText) {
  EXPECT_EQ(escaped("a\xFF<\xC3"), "a\xEF\xBF\xBD&lt;\xEF\xBF\xBD");
  EXPECT_EQ(escaped("\xC3\xA9\\\n"), "\xC3\xA9\\\n");
}

TEST(Report, HoldsNoControlCharacters) {
  EXPECT_EQ(escaped("a\x01\x1b[31m\x7f\tb\r\n"), "a\xEF\xBF\xBD\xEF\xBF\xBD[31m\xEF\xBF\xBD\tb\r\n");
}

TEST(Report, LinesThatFollowEachOtherStandInOneBlock) {
  Report report("t", "l");
  report.lines("a  <1>\n");
  report.lines("bb  2\n");
  report.paragraph("p");
  report.lines("c\n");
  EXPECT_TRUE(holds(report.html(), "<pre>a  &lt;1&gt;\nbb  2\n</pre>\n<p>p</p>\n<pre>c\n</pre>"));
}

TEST(Report, LoadsNothing) {
  Image image(2, 2);
  Report report("t", "l");
  report.pictures({{"one", "a caption", image}, {"two", "", image}});
  const std::string html = report.html();
  // A PNG file begins 89 50 4e 47 0d 0a 1a 0a.
  EXPECT_TRUE(holds(html, "src=\"data:image/png;base64,iVBORw0KGgo"));
  for (std::string_view loader : {"http:", "https:", "<link", "@import", "url("})
    EXPECT_FALSE(holds(html, loader));
}

TEST(Report, HoldsDrawingsAsPicturesOfTheirOwn) {
  Report report("t", "l");
  report.drawing("a <curve>", "<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
  const std::string html = report.html();
  EXPECT_TRUE(holds(html, "src=\"data:image/svg+xml;base64,PHN2ZyB4bWxucz0i"));
  EXPECT_TRUE(holds(html, "<figcaption>a &lt;curve&gt;</figcaption>"));
  EXPECT_FALSE(holds(html, "<svg"));
}

TEST(Report, RowsHaveACellForEachColumn) {
  Report report("t", "l");
  EXPECT_THROW(report.table("", {{"a"}, {"b"}}, {{"1"}}), ModelError);
}

}  // namespace
}  // namespace splatscope::studies
