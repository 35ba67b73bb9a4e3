#include "traces/models/obj_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "model/byte_order_mark.h"
#include "model/error.h"
#include "model/input_file.h"
#include "model/stop.h"

namespace splatscope::traces {
namespace {

constexpr std::string_view kBlanks = " \t\f\v";

bool is_number(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return end == word.data() + word.size() && error != std::errc::invalid_argument;
}

// Goes over the text line by line.
class ObjText {
 public:
  ObjText(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  std::string read() {
    std::size_t at = 0;
    if (text_.starts_with(kByteOrderMark)) at = leave_out(0, kByteOrderMark.size());
    while (at < text_.size()) {
      stop_if_asked();
      ++line_;
      const std::size_t end = std::min(text_.find_first_of("\r\n", at), text_.size());
      read_line(at, end);
      at = end + (text_.substr(end).starts_with("\r\n") ? 2 : 1);
    }
    if (copied_ > 0) result_ += text_.substr(copied_);
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(std::string_view what, std::string_view expected) const {
    throw UserError(file_, line_, fmt::format("{}, expected {}", what, expected));
  }

  std::size_t leave_out(std::size_t begin, std::size_t end) {
    result_ += text_.substr(copied_, begin - copied_);
    return copied_ = end;
  }

  // From `at` on.
  std::string_view word(std::size_t& at, std::size_t line_end) const {
    const std::string_view line = text_.substr(0, line_end);
    at = std::min(line.find_first_not_of(kBlanks, at), line_end);
    return line.substr(at, line.find_first_of(kBlanks, at) - at);
  }

  // A line that ends with \ goes on in the next one.
  void read_line(std::size_t at, std::size_t end) {
    const bool goes_on = end > at && text_[end - 1] == '\\';
    if (goes_on) --end;
    if (!continued_) {
      const std::size_t begin = at;
      const std::string_view keyword = word(at, end);
      if (at > begin) leave_out(begin, at);
      is_place_ = keyword == "v";
      has_numbers_ = is_place_ || keyword == "vt" || keyword == "vn";
      is_element_ = keyword == "f" || keyword == "fo" || keyword == "l" || keyword == "p";
      numbers_ = 0;
      at += keyword.size();
    }
    continued_ = goes_on;
    if (has_numbers_ || is_element_) {
      const std::size_t comment = std::min(text_.substr(0, end).find('#', at), end);
      if (has_numbers_) read_numbers(at, comment);
      if (comment < end) leave_out(comment, end);
    }
    if (is_place_ && !continued_ && numbers_ != 3 && numbers_ != 4 && numbers_ != 6)
      fail(fmt::format("a vertex of {} number{}", numbers_, numbers_ == 1 ? "" : "s"), "3, 4 or 6");
    if (!is_place_ || continued_) return;
    const bool colored = numbers_ == 6;
    if (colored_.value_or(colored) != colored)  // assimp would make the others black
      fail("vertices with colours beside ones without", "colours for all or for none");
    colored_ = colored;
  }

  void read_numbers(std::size_t at, std::size_t end) {
    for (std::string_view number; !(number = word(at, end)).empty(); at += number.size()) {
      const char first = number.front();
      ++numbers_;
      if (first == '-' || first == '+' || (first >= '0' && first <= '9')) continue;
      if (!is_number(number)) fail(fmt::format("\"{}\" is no number", number.substr(0, 64)), "a number");
      leave_out(at, at);
      result_ += '+';
    }
  }

  std::string_view text_, file_;
  int line_ = 0;
  bool continued_ = false, has_numbers_ = false, is_place_ = false, is_element_ = false;
  std::optional<bool> colored_;  // the vertices before
  std::size_t numbers_ = 0;      // of the line
  std::string result_;
  std::size_t copied_ = 0;  // of the text; 0: nothing had to change
};

}  // namespace

std::string obj_text(const std::filesystem::path& path) {
  const std::string text = file_bytes(path), file = path.string();
  return ObjText(text, file).read();
}

}  // namespace splatscope::traces
