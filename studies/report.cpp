#include "studies/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <span>

#include "model/embedded_file.h"
#include "model/error.h"
#include "studies/json_text.h"
#include "traces/output_files.h"

namespace splatscope {
std::span<const EmbeddedFile> report_files();  // made from report/ by studies/build.cmake
}

namespace splatscope::studies {
namespace {

std::string_view embedded(std::string_view name) {
  return std::ranges::find(report_files(), name, &EmbeddedFile::name)->text;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (char c : valid_utf8(text)) {
    constexpr std::string_view kBlanks = "\t\n\r";
    const bool is_control = std::iscntrl(static_cast<unsigned char>(c)) != 0;
    if (is_control && kBlanks.find(c) == std::string_view::npos) {  // no page may hold one
      result += "\xef\xbf\xbd";
      continue;
    }
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

namespace {

// RFC 4648.
std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t present = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < present ? std::to_integer<unsigned>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= present ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string_view attribute(Report::Align align) {
  return align == Report::Align::number  ? " class=\"number\""
         : align == Report::Align::prose ? " class=\"prose\""
                                         : "";
}

// A picture of its own size; only on a screen narrower than that it is scaled.
std::string picture_figure(const Report::Picture& picture, std::string_view inside) {
  return fmt::format("<figure style=\"width: {}px\">{}<figcaption><b>{}</b> {}</figcaption></figure>\n",
                     picture.image.width, inside, escaped(picture.title), escaped(picture.caption));
}

// Red, green and blue are the bytes of a count.
Image bytes_of(const GrayImage& counts) {
  Image image(counts.width, counts.height);
  for (std::size_t i = 0; i < counts.pixels.size(); ++i) {
    const auto count = static_cast<std::uint32_t>(std::min(counts.pixels[i], 0x1p24f - 1));
    for (std::size_t byte = 0; byte < 3; ++byte)
      image.pixels[i][byte] = static_cast<float>(count >> 8 * byte & 0xff) / 255;
  }
  return image;
}

std::string counts_attributes(const Report::Counts& counts) {
  return fmt::format("data-unit=\"{}\" data-counts=\"data:image/png;base64,{}\" ", escaped(counts.unit),
                     base64(encode_png(bytes_of(*counts.counts))));
}

std::string image_tag(const Report::Picture& picture, std::string_view attributes = "") {
  return fmt::format("<img width=\"{}\" height=\"{}\" alt=\"{}\" {}src=\"data:image/png;base64,{}\">",
                     picture.image.width, picture.image.height, escaped(picture.title), attributes,
                     base64(encode_png(picture.image)));
}

}  // namespace

Report::Report(std::string_view title, std::string_view lead)
    : title_(escaped(title)),
      body_(fmt::format("<h1>{}</h1>\n<p class=\"lead\">{}</p>\n", title_, escaped(lead))) {}

void Report::heading(std::string_view text) {
  body_ += fmt::format("<h2>{}</h2>\n", escaped(text));
}

void Report::paragraph(std::string_view text) {
  body_ += fmt::format("<p>{}</p>\n", escaped(text));
}

void Report::lines(std::string_view text) {
  constexpr std::string_view kEnd = "</pre>\n";
  if (body_.ends_with(kEnd)) {
    body_.erase(body_.size() - kEnd.size());
  } else {
    body_ += "<pre>";
  }
  body_ += escaped(text);
  body_ += kEnd;
}

void Report::table(std::string_view caption, const std::vector<Column>& columns,
                   const std::vector<std::vector<std::string>>& rows) {
  body_ += fmt::format("<p class=\"caption\">{}</p>\n", escaped(caption));
  add_table(columns, rows);
}

void Report::folded_table(std::string_view summary, const std::vector<Column>& columns,
                          const std::vector<std::vector<std::string>>& rows) {
  body_ += fmt::format("<details><summary>{}</summary>\n", escaped(summary));
  add_table(columns, rows);
  body_ += "</details>\n";
}

void Report::add_table(const std::vector<Column>& columns,
                       const std::vector<std::vector<std::string>>& rows) {
  body_ += "<div class=\"table\"><table>\n<thead><tr>";
  for (const Column& column : columns)
    body_ += fmt::format("<th scope=\"col\"{}>{}</th>", attribute(column.align), escaped(column.name));
  body_ += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows) {
    if (row.size() != columns.size()) throw ModelError("Report::table: a row has not a cell for each column");
    body_ += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      body_ += fmt::format("<td{}>{}</td>", attribute(columns[i].align), escaped(row[i]));
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void Report::pictures(const std::vector<Picture>& pictures) {
  body_ += "<div class=\"pictures\">\n";
  for (const Picture& picture : pictures) {
    body_ += picture_figure(
        picture,
        fmt::format("<button type=\"button\" class=\"magnify\" title=\"magnify\">{}"
                    "</button>",
                    image_tag(picture, picture.counts ? counts_attributes(*picture.counts) : std::string())));
  }
  body_ += "</div>\n";
}

void Report::comparisons(const std::vector<Comparison>& comparisons) {
  body_ += "<div class=\"pictures\">\n";
  for (const Comparison& c : comparisons) {
    const std::string name = fmt::format("comparison{}", ++comparisons_);
    std::string inside = "<div class=\"comparison\"><div class=\"layers\">";
    inside += image_tag({"reference", "", c.reference}, "class=\"under\" data-name=\"reference\" ");
    inside += image_tag({"difference", "", c.difference}, "class=\"under\" data-name=\"difference\" hidden ");
    inside += image_tag({"simulated", "", c.simulated.image}, "class=\"over\" ");
    inside += fmt::format(
        "</div><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"line between simulated "
        "and what is right of it\"><div class=\"choice\"><span>left: simulated; right:</span><label><input "
        "type=\"radio\" name=\"{0}\" value=\"reference\" checked> reference</label><label><input "
        "type=\"radio\" "
        "name=\"{0}\" value=\"difference\"> difference, 16 times</label></div></div>",
        name);
    body_ += picture_figure(c.simulated, inside);
  }
  body_ += "</div>\n";
}

void Report::diagram(std::string_view caption, std::string_view svg, const std::vector<LegendEntry>& legend) {
  body_ += fmt::format("<figure class=\"machine\">{}<p class=\"legend\">", svg);
  for (const LegendEntry& entry : legend)
    body_ += fmt::format("<span><i class=\"{0}\"></i>{0}: {1}</span>", entry.name, escaped(entry.what));
  body_ += fmt::format("</p><figcaption>{}</figcaption></figure>\n", escaped(caption));
}

void Report::drawing(std::string_view caption, std::string_view svg) {
  // As a picture of its own: its identifiers and styles then stay apart from the page's.
  body_ += fmt::format(
      "<figure class=\"drawing\"><img alt=\"{0}\" src=\"data:image/svg+xml;base64,{1}\">"
      "<figcaption>{0}</figcaption></figure>\n",
      escaped(caption), base64(std::as_bytes(std::span(svg.data(), svg.size()))));
}

std::string Report::html() const {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n{}<script>\n{}</script>\n</body>\n</html>\n",
      title_, embedded("report.css"), body_, embedded("report.js"));
}

void Report::write(const std::filesystem::path& path) const {
  traces::write_file(path, html());
}

}  // namespace splatscope::studies
