#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/image_io.h"

namespace splatscope::studies {

// Text as HTML or SVG holds it, which are UTF-8.
std::string escaped(std::string_view text);

// Builds one self-contained HTML page, from top to bottom: style, script and pictures are inside, nothing is
// loaded. All texts are plain and are escaped here.
class Report {
 public:
  // `lead` stands under the title: what the page shows, in a sentence or two.
  Report(std::string_view title, std::string_view lead);

  void heading(std::string_view text);
  void paragraph(std::string_view text);
  // Text in lines as they are, in letters of one width. What comes next in this way goes on in the same
  // block.
  void lines(std::string_view text);

  enum class Align { text, number, prose };  // prose is broken into lines
  struct Column {
    std::string name;
    Align align = Align::text;
  };
  // Each row has a cell for each column.
  void table(std::string_view caption, const std::vector<Column>& columns,
             const std::vector<std::vector<std::string>>& rows);
  // The same, folded away until it is asked for.
  void folded_table(std::string_view summary, const std::vector<Column>& columns,
                    const std::vector<std::vector<std::string>>& rows);

  // What the colours of a picture stand for: a count of each pixel, or of each square of pixels.
  struct Counts {
    const GrayImage* counts;  // from 0; what is 2^24 and more is told as that
    std::string unit;
  };
  struct Picture {
    std::string title;
    std::string caption;
    const Image& image;
    std::optional<Counts> counts = {};  // told of a magnified pixel in place of its colours
  };
  // Side by side where the screen is wide enough, pixel for pixel: a scaled picture would hide or add
  // aliasing. Only on a screen narrower than the picture it is scaled. Each opens magnified.
  void pictures(const std::vector<Picture>& pictures);

  // A picture that a slider parts from its reference, or from their difference. All of one size.
  struct Comparison {
    Picture simulated;
    const Image& reference;
    const Image& difference;  // amplified 16 times about mid-grey (difference_picture)
  };
  void comparisons(const std::vector<Comparison>& comparisons);

  // A picture in SVG, drawn to scale.
  void drawing(std::string_view caption, std::string_view svg);

  // A drawing that is part of the page and takes its colours from it. `svg` is HTML already. `name` is a
  // class of the page's style.
  struct LegendEntry {
    std::string_view name, what;
  };
  void diagram(std::string_view caption, std::string_view svg, const std::vector<LegendEntry>& legend);

  std::string html() const;
  // The file appears whole or not at all. Throws UserError where the place cannot be written.
  void write(const std::filesystem::path& path) const;

 private:
  void add_table(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows);

  int comparisons_ = 0;
  std::string title_;  // escaped
  std::string body_;
};

}  // namespace splatscope::studies
