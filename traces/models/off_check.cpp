#include "traces/models/off_check.h"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/error.h"
#include "model/stop.h"
#include "traces/words.h"

namespace splatscope::traces {
namespace {

constexpr std::uint64_t kMostCorners = 9;  // of a face, in assimp

class OffCheck {
 public:
  explicit OffCheck(const std::filesystem::path& path)
      : file_(path.string()), size_(std::filesystem::file_size(path)), in_(path, std::ios::binary) {}

  void check() {
    std::string word = header_word();
    const bool keyword = !signed_number_of<std::uint64_t>(word);  // which may be missing
    const std::size_t numbers = keyword ? numbers_of_a_vertex(word) : 3;
    if (keyword) word = header_word();
    const std::uint64_t vertices = count(word, "vertices"), faces = count(header_word(), "faces");
    header_word();  // the edges, which nobody counts
    while (words_.empty() && next_line()) {
    }
    for (std::uint64_t i = 0; i < vertices; ++i) check_vertex(numbers);
    for (std::uint64_t i = 0; i < faces; ++i) check_face();
    do {
      if (!words_.empty()) fail("a line more than the header counts", "the end of the file");
    } while (next_line());
  }

 private:
  [[noreturn]] void fail(std::string_view what, std::string_view expected) const {
    throw UserError(file_, line_, fmt::format("{}, expected {}", what, expected));
  }

  // False at the end of the file.
  bool next_line() {
    stop_if_asked();
    words_.clear();
    if (!std::getline(in_, text_)) return false;
    ++line_;
    words_ = words_of(std::string_view(text_).substr(0, text_.find('#')), " \t\r\f\v");
    return true;
  }

  // Empty at the end of the file.
  std::string header_word() {
    while (words_.empty() && next_line()) {
    }
    if (words_.empty()) return {};
    std::string word(words_.front());
    words_.erase(words_.begin());
    return word;
  }

  // At least. `keyword` tells; the number of dimensions may follow it.
  std::size_t numbers_of_a_vertex(std::string_view keyword) {
    const bool known = keyword.ends_with("OFF");
    if (known) keyword.remove_suffix(3);
    std::size_t numbers = 0;
    const auto take = [&](std::string_view letters, std::size_t of_them) {
      if (!keyword.starts_with(letters)) return false;
      keyword.remove_prefix(letters.size());
      numbers += of_them;
      return true;
    };
    take("ST", 2);
    const bool colors = take("C", 4);  // fewer in other readers
    if (take("N", 3) && colors)
      fail("colours beside normals, which assimp reads one number off", "one of them");
    take("4", 1);
    const bool counted = take("n", 0);
    if (!known || !keyword.empty()) fail("the first word is not \"OFF\"", "an OFF file");
    const auto dimensions = counted ? signed_number_of<std::size_t>(header_word()) : 3;
    if (!dimensions || *dimensions > 3) fail("a wrong number of dimensions", "1 to 3");
    return numbers + *dimensions;
  }

  std::uint64_t count(std::string_view word, std::string_view what) const {
    const auto count = signed_number_of<std::uint64_t>(word);
    if (!count || *count > size_ / 2)
      throw UserError(file_, 0,
                      fmt::format("\"{}\" {} do not fit in its {} bytes, expected a whole OFF file",
                                  word.substr(0, 64), what, size_));
    return *count;
  }

  // assimp passes over empty lines alone. `words_` are those of the row from here on, up to end_row.
  void begin_row() {
    while (words_.empty()) {
      if (!next_line()) fail("the file ends within its data", "a line of numbers");
      if (words_.empty() && !text_.empty() && text_ != "\r")
        fail("blanks or a comment between the rows", "a line of numbers");
    }
  }

  void expect_numbers(std::size_t count) const {
    if (words_.size() < count)
      fail(fmt::format("{} number{}", words_.size(), words_.size() == 1 ? "" : "s"),
           fmt::format("{} or more", count));
  }

  void check_vertex(std::size_t numbers) {
    begin_row();
    expect_numbers(numbers);
    for (std::string_view word : std::span(words_).first(numbers))
      if (!signed_number_of<double>(word))
        fail(fmt::format("\"{}\" is no number", word.substr(0, 64)), "a number");
    words_.clear();
  }

  void check_face() {
    begin_row();
    const auto corners = signed_number_of<std::uint64_t>(words_.front());
    if (!corners || *corners < 1 || *corners > kMostCorners)
      fail(fmt::format("a face of \"{}\" corners", words_.front().substr(0, 64)),
           fmt::format("1 to {}, as assimp does", kMostCorners));
    expect_numbers(1 + *corners);
    for (std::string_view word : std::span(words_).subspan(1, *corners))
      if (!signed_number_of<std::uint64_t>(word))
        fail(fmt::format("\"{}\" is no vertex", word.substr(0, 64)), "a whole number from 0 on");
    words_.clear();
  }

  std::string file_;
  std::uintmax_t size_;
  std::ifstream in_;
  std::string text_;
  std::vector<std::string_view> words_;  // of the line, not looked at yet
  int line_ = 0;
};

}  // namespace

void expect_whole_off(const std::filesystem::path& path) {
  OffCheck(path).check();
}

}  // namespace splatscope::traces
