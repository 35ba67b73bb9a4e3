#include "traces/ply_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "model/error.h"
#include "model/stop.h"
#include "traces/words.h"

namespace splatscope::traces {
namespace {

class AsciiValues : public PlyValues {
 public:
  AsciiValues(std::istream& in, std::string_view file, int line, PlyTypes types)
      : in_(*in.rdbuf()), file_(file), line_(line + 1), types_(types) {}

  // Lines without a word are passed over.
  void begin_row(const PlyElement& element) override {
    element_ = &element;
    read_ = 0;
    if (!skip_blank_lines()) fail("the file ends within its data", "a number");
  }

  // Of any type: an ASCII file's numbers are what they are.
  double next(PlyType) override { return number(next_word()); }

  void skip(PlyType type, std::uint64_t count) override {
    const bool whole = types_ == PlyTypes::enforced && is_integer(type);
    for (; count > 0; --count) {
      stop_if_asked();
      const std::string_view word = next_word();
      if (!is_plain(word)) number(word);
      if (whole && word.find_first_not_of("+-0123456789") != word.npos)
        fail(fmt::format("\"{}\" is no whole number", word), fmt::format("a value of type {}", name(type)));
    }
  }

  void end_row() override {
    const std::size_t expected = read_;
    for (; !at_line_end(); ++read_)
      for (int c = in_.sgetc(); c != kEnd && !is_space(c) && c != '\n'; c = in_.snextc()) stop_if_asked();
    if (read_ != expected) fail(numbers(read_), fmt::format("{}", expected));
  }

  // Nothing but blank lines may follow.
  void end() override {
    if (skip_blank_lines()) fail("a line more than the header counts", "the end of the file");
  }

  [[noreturn]] void fail(std::string_view what, std::string_view expected) const override {
    throw UserError(file_, line_, fmt::format("{}, expected {}", what, expected));
  }

 private:
  static constexpr int kEnd = std::char_traits<char>::eof();

  static bool is_space(int c) { return c == ' ' || c == '\t' || c == '\r'; }

  // Surely a number: digits, perhaps with a sign and a point. Most are, and this is faster than to read them.
  static bool is_plain(std::string_view word) {
    if (word.front() == '-') word.remove_prefix(1);
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (word.empty() || !is_digit(word.front())) return false;
    std::size_t points = 0;
    for (char c : word) {
      points += c == '.';
      if (!is_digit(c) && c != '.') return false;
    }
    return points <= 1;
  }

  double number(std::string_view word) const {
    const auto value = signed_number_of<double>(word);
    if (!value) fail(fmt::format("\"{}\" is no number", word), "a number");
    return *value;
  }

  static std::string numbers(std::size_t count) {
    return fmt::format("{} number{}", count, count == 1 ? "" : "s");
  }

  bool at_line_end() {
    int c = in_.sgetc();
    while (is_space(c)) c = in_.snextc();
    return c == '\n' || c == kEnd;
  }

  // False at the end of the file.
  bool skip_blank_lines() {
    while (at_line_end()) {
      stop_if_asked();
      if (in_.sbumpc() == kEnd) return false;
      ++line_;
    }
    return true;
  }

  std::string_view next_word() {
    if (at_line_end()) {
      const bool has_list = std::ranges::any_of(element_->properties, &PlyProperty::is_list);
      fail(numbers(read_), has_list ? "more" : fmt::format("{}", element_->properties.size()));
    }
    std::size_t size = 0;
    for (int c = in_.sgetc(); c != kEnd && c != '\n' && !is_space(c); c = in_.snextc()) {
      if (size == sizeof word_) fail("a word does not end", "a number");
      word_[size++] = static_cast<char>(c);
    }
    ++read_;
    return {word_, size};
  }

  std::streambuf& in_;
  std::string_view file_;
  int line_;
  PlyTypes types_;
  const PlyElement* element_ = nullptr;  // of the row
  std::size_t read_ = 0;                 // numbers of the row
  char word_[64];
};

template <class Value>
double decode(const unsigned char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

class BinaryValues : public PlyValues {
 public:
  BinaryValues(std::istream& in, std::string_view file, std::uintmax_t file_size, bool big_endian)
      : in_(in),
        file_(file),
        offset_(in.tellg()),
        size_(static_cast<std::streamoff>(file_size)),
        swap_(big_endian != (std::endian::native == std::endian::big)) {}

  double next(PlyType type) override {
    unsigned char bytes[8];
    const auto size = static_cast<std::streamsize>(size_in_bytes(type));
    if (in_.rdbuf()->sgetn(reinterpret_cast<char*>(bytes), size) != size)
      fail("the file ends within its data", fmt::format("a value of {} bytes", size));
    offset_ += size;
    if (swap_) std::reverse(bytes, bytes + size);
    switch (type) {
      case PlyType::int8:
        return decode<std::int8_t>(bytes);
      case PlyType::uint8:
        return decode<std::uint8_t>(bytes);
      case PlyType::int16:
        return decode<std::int16_t>(bytes);
      case PlyType::uint16:
        return decode<std::uint16_t>(bytes);
      case PlyType::int32:
        return decode<std::int32_t>(bytes);
      case PlyType::uint32:
        return decode<std::uint32_t>(bytes);
      case PlyType::float32:
        return decode<float>(bytes);
      case PlyType::float64:
        return decode<double>(bytes);
    }
    throw ModelError("BinaryValues: no such type");
  }

  void skip(PlyType type, std::uint64_t count) override {
    const std::uint64_t size = size_in_bytes(type), left = static_cast<std::uint64_t>(size_ - offset_);
    if (count > left / size)
      fail("the file ends within its data", fmt::format("{} values of {} bytes", count, size));
    in_.ignore(static_cast<std::streamsize>(count * size));
    offset_ += static_cast<std::streamoff>(count * size);
  }

  [[noreturn]] void fail(std::string_view what, std::string_view expected) const override {
    throw UserError(file_, 0, fmt::format("{} at byte {}, expected {}", what, offset_, expected));
  }

 private:
  std::istream& in_;
  std::string_view file_;
  std::streamoff offset_, size_;
  bool swap_;
};

}  // namespace

std::unique_ptr<PlyValues> ply_values(std::istream& in, std::string_view file, std::uintmax_t file_size,
                                      const PlyHeader& header, PlyTypes types) {
  if (header.encoding == PlyEncoding::ascii)
    return std::make_unique<AsciiValues>(in, file, header.lines, types);
  return std::make_unique<BinaryValues>(in, file, file_size,
                                        header.encoding == PlyEncoding::binary_big_endian);
}

void skip_list(PlyValues& values, const PlyProperty& property) {
  const double count = values.next(property.count_type);
  if (!(count >= 0 && count <= 4294967295.0 && count == std::floor(count)))
    values.fail(fmt::format("a list of {} items", count), "0 or more");
  values.skip(property.type, static_cast<std::uint64_t>(count));
}

void skip_element(PlyValues& values, const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    stop_if_asked();
    values.begin_row(element);
    for (const PlyProperty& property : element.properties)
      property.is_list ? skip_list(values, property) : values.skip(property.type, 1);
    values.end_row();
  }
}

}  // namespace splatscope::traces
