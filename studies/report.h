#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "studies/image_io.h"

namespace splatscope::studies {

// Builds one self-contained HTML page, from top to bottom: style and pictures are inside, nothing is loaded.
// All texts are plain and are escaped here.
class Report {
 public:
  // `lead` stands under the title: what the page shows, in a sentence or two.
  Report(std::string_view title, std::string_view lead);

  void heading(std::string_view text);
  void paragraph(std::string_view text);

  enum class Align { text, number };
  struct Column {
    std::string name;
    Align align = Align::text;
  };
  // Each row has a cell for each column.
  void table(std::string_view caption, const std::vector<Column>& columns,
             const std::vector<std::vector<std::string>>& rows);

  struct Picture {
    std::string title;
    std::string caption;
    const Image& image;
  };
  // Side by side where the screen is wide enough, pixel for pixel: a scaled picture would hide or add
  // aliasing. Only on a screen narrower than the picture it is scaled.
  void pictures(const std::vector<Picture>& pictures);

  // A picture in SVG, drawn to scale.
  void drawing(std::string_view caption, std::string_view svg);

  std::string html() const;
  // The file appears whole or not at all. Throws UserError where the place cannot be written.
  void write(const std::filesystem::path& path) const;

 private:
  std::string title_;  // escaped
  std::string body_;
};

}  // namespace splatscope::studies
