#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"
#include "studies/report.h"

// report.html as a reader meets it: in Chromium, wide and narrow. The page is opened with a script of ours in
// it, which uses the page and leaves what it saw in an attribute.
namespace splatscope::tests {
namespace {

constexpr std::string_view kNoteErrors = R"(<script>
const errors = [];
addEventListener("error", (event) => errors.push(String(event.message)));
addEventListener("unhandledrejection", (event) => errors.push(String(event.reason)));
</script>)";

constexpr std::string_view kUseThePage = R"(<script>
addEventListener("load", async () => {
  const saw = { comparisons: 0, zooms: 0, pixels: [] };
  const clock = setInterval(() => {}, 1);  // or virtual time runs out while a picture is being decoded
  for (const image of document.images) image.closest("details")?.setAttribute("open", "");
  const images = [...document.images].filter((image) => image.hasAttribute("src"));
  saw.images = images.length;
  saw.not_loaded = images.filter((image) => !image.complete || image.naturalWidth === 0).length;
  saw.overflow = document.documentElement.scrollWidth - innerWidth;
  saw.width = innerWidth;
  for (const comparison of document.querySelectorAll(".comparison")) {
    const slider = comparison.querySelector("input[type=range]");
    const cut = () => getComputedStyle(comparison.querySelector(".over")).clipPath;
    const seen = (name) => getComputedStyle(comparison.querySelector(`[data-name=${name}]`)).visibility === "visible";
    const before = cut();
    slider.value = 20;
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    const reference_first = seen("reference") && !seen("difference");
    comparison.querySelector("input[value=difference]").click();
    saw.comparisons += before !== cut() && cut().includes("80%") && reference_first && seen("difference") &&
                       !seen("reference");
  }
  const dialog = document.querySelector("dialog");
  for (const opener of document.querySelectorAll(".magnify, .layers")) {
    opener.click();
    const shown = dialog.querySelector("img");
    await shown.decode();
    await new Promise((done) => setTimeout(done));  // what the page waited for has run
    const width = shown.getBoundingClientRect().width;
    dialog.querySelector("[data-step='1']").click();
    const box = shown.getBoundingClientRect();
    shown.dispatchEvent(new PointerEvent("pointermove", { clientX: box.left + 1, clientY: box.top + 1 }));
    saw.pixels.push(dialog.querySelector(".pixel").textContent);
    saw.zooms += dialog.open && width >= shown.naturalWidth && box.width > width &&
                 dialog.querySelector(".pixel").textContent.startsWith("pixel 0,0: ");
    dialog.querySelector("[data-close]").click();
    if (dialog.open) errors.push("the dialog does not close");
  }
  saw.loaded = performance.getEntriesByType("resource").map((entry) => entry.name.slice(0, 80));
  saw.errors = errors;
  clearInterval(clock);
  document.documentElement.dataset.saw = encodeURIComponent(JSON.stringify(saw));
});
</script>)";

// What the script saw of a page in a window `width` pixels wide; null where the browser did not wait for its
// end, which a busy machine may bring about.
nlohmann::json saw_of(const std::string& page, int width) {
  const ScratchFolder scratch;
  std::string with = page;
  with.insert(with.find("<head>") + 6, kNoteErrors);
  with.insert(with.rfind("</body>"), kUseThePage);
  scratch.file("page.html", with);
  const std::string command = fmt::format(
      "cd '{}' && timeout 120 chromium-headless-shell --no-sandbox --disable-gpu --user-data-dir=profile "
      "--window-size={},900 --virtual-time-budget=20000 --enable-logging=stderr --dump-dom page.html >dom "
      "2>log",
      scratch.path().string(), width);
  EXPECT_EQ(0, std::system(command.c_str())) << "expected the package chromium-headless-shell\n"
                                             << text_of(scratch.path() / "log");
  EXPECT_EQ(std::string::npos, text_of(scratch.path() / "log").find(":CONSOLE"))
      << text_of(scratch.path() / "log");
  const std::string dom = text_of(scratch.path() / "dom"), attribute = "data-saw=\"";
  const std::size_t begin = dom.find(attribute);
  if (begin == std::string::npos) return nullptr;
  std::string text;  // percent-encoded
  for (std::size_t i = begin + attribute.size(); dom[i] != '"'; ++i) {
    text += dom[i] == '%' ? static_cast<char>(std::stoi(dom.substr(i + 1, 2), nullptr, 16)) : dom[i];
    if (dom[i] == '%') i += 2;
  }
  return nlohmann::json::parse(text);
}

// `pixel`: what the last picture says of its first one.
void expect_usable(const std::string& page, int images, int comparisons, int zooms, std::string_view pixel) {
  for (const int width : {1280, 360}) {
    nlohmann::json saw;
    for (int tries = 0; tries < 5 && saw.is_null(); ++tries) saw = saw_of(page, width);
    ASSERT_FALSE(saw.is_null()) << "the script did not come to its end";
    EXPECT_EQ(nlohmann::json::array(), saw.at("errors"));
    EXPECT_EQ(width, saw.at("width"));
    EXPECT_LE(saw.at("overflow"), 0);
    EXPECT_EQ(images, saw.at("images"));
    EXPECT_EQ(0, saw.at("not_loaded"));
    EXPECT_EQ(comparisons, saw.at("comparisons"));
    EXPECT_EQ(zooms, saw.at("zooms"));
    EXPECT_EQ(pixel, saw.at("pixels").back().get<std::string>());
    EXPECT_EQ(nlohmann::json::array(), saw.at("loaded")) << "nothing is loaded";
  }
}

TEST(ReportInBrowser, EveryPartOfAPageWorks) {
  studies::Image image(600, 40);
  studies::Report report("A page", "With all that a page can hold.");
  report.heading("A heading");
  report.paragraph(
      "A-word-that-is-far-too-long-for-a-narrow-screen-and-has-to-be-broken-somewhere-in-its-middle");
  const std::vector<std::string> row(12, "a cell that is wide");
  report.table("A table", std::vector<studies::Report::Column>(12, {"column"}), {row});
  report.folded_table("Another", std::vector<studies::Report::Column>(12, {"column"}), {row});
  report.pictures({{"one", "a picture", image}, {"two", "", image}});
  report.comparisons({{{"three", "", image}, image, image}, {{"four", "", image}, image, image}});
  report.drawing("A drawing", "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"720\" height=\"40\"/>");
  studies::GrayImage counts{300, 20, std::vector<float>(300 * 20, 7)};
  counts.pixels[0] = 70000;
  report.pictures({{"five", "", image, studies::Report::Counts{&counts, "fragments"}}});
  expect_usable(report.html(), 10, 2, 5, "pixel 0,0: 70000 fragments");
}

TEST(ReportInBrowser, APageThatRunWroteWorks) {
  const ScratchFolder folder;
  folder.file(
      "small.toml",
      "surfels = { columns = 24, rows = 20 }\nframe = { width = 400, height = 48 }\ncapture.views = 1\n"
      "camera = { eye = [0, 14, -20], target = [0, 0, 0] }\n");
  ASSERT_EQ(0, run_program({"run", "small.toml", "--reference", "--out", "out"}, folder.path()).status);
  const std::string page = text_of(folder.path() / "out" / "report.html");
  expect_usable(page, 4, 1, 1, "pixel 0,0: 0 0 0");
  for (const char* part : {"Roofline", "vertex0: busy ", "raster to depth: ", "vertex.units",
                           "fragments_passed", "<td>splat_ewa.vs</td><td class=\"number\">78</td>"})
    EXPECT_NE(std::string::npos, page.find(part)) << part;
}

}  // namespace
}  // namespace splatscope::tests
