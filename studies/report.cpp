#include "studies/report.h"

#include <fmt/format.h>

#include <span>

#include "model/error.h"
#include "traces/output_files.h"

namespace splatscope::studies {
namespace {

constexpr std::string_view kStyle = R"css(
:root { color-scheme: light dark; --ink: #1c2024; --dim: #60676f; --line: #d9dde1; --paper: #fff; --band: #f5f7f8; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e8ea; --dim: #9aa2aa; --line: #3a4046; --paper: #16191c; --band: #1e2226; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2.5rem 1.25rem 4rem; max-width: 102rem; color: var(--ink); background: var(--paper);
       font: 16px/1.55 system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
h1 { margin: 0 0 .5rem; font-size: 1.9rem; line-height: 1.2; letter-spacing: -.01em; }
h2 { margin: 2.5rem 0 .75rem; font-size: 1.25rem; }
h1, p { max-width: 44rem; }
p { margin: .75rem 0; }
.lead { color: var(--dim); font-size: 1.05rem; }
.caption { color: var(--dim); font-size: .92rem; margin-bottom: .25rem; }
.table { overflow-x: auto; margin: 0 0 1rem; }
table { border-collapse: collapse; font-size: .92rem; }
th, td { padding: .4rem .9rem .4rem 0; text-align: left; white-space: nowrap; border-bottom: 1px solid var(--line); }
th { border-bottom: 2px solid var(--ink); vertical-align: bottom; }
tbody tr:hover { background: var(--band); }
.number { text-align: right; font-variant-numeric: tabular-nums; }
.pictures { display: flex; flex-wrap: wrap; gap: 1.5rem; margin: 1.25rem 0; }
figure { margin: 0; max-width: 100%; }
img { display: block; width: 100%; height: auto; }
figcaption { margin-top: .5rem; font-size: .9rem; color: var(--dim); }
.drawing { max-width: 45rem; margin: 1.25rem 0; }
figcaption b { color: var(--ink); }
)css";

std::string escaped(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (char c : text) {
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
  return align == Report::Align::number ? " class=\"number\"" : "";
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

void Report::table(std::string_view caption, const std::vector<Column>& columns,
                   const std::vector<std::vector<std::string>>& rows) {
  body_ +=
      fmt::format("<p class=\"caption\">{}</p>\n<div class=\"table\"><table>\n<thead><tr>", escaped(caption));
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
  for (const Picture& p : pictures)
    body_ += fmt::format(
        "<figure style=\"width: {0}px\"><img width=\"{0}\" height=\"{1}\" alt=\"{2}\" "
        "src=\"data:image/png;base64,{3}\"><figcaption><b>{2}</b> {4}</figcaption></figure>\n",
        p.image.width, p.image.height, escaped(p.title), base64(encode_png(p.image)), escaped(p.caption));
  body_ += "</div>\n";
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
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      title_, kStyle, body_);
}

void Report::write(const std::filesystem::path& path) const {
  traces::write_file(path, html());
}

}  // namespace splatscope::studies
