#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string_view>

#include "traces/ply_header.h"

namespace splatscope::traces {

// The values after the header of a PLY file, one at a time. In ASCII those of each vertex, or other thing,
// are a line. All throw UserError where the file has not what is asked for: "file:line: ..." (ASCII) or
// "file: ... at byte N ..." (binary).
class PlyValues {
 public:
  virtual ~PlyValues() = default;
  virtual void begin_row(const PlyElement&) {}
  virtual double next(PlyType type) = 0;
  virtual void skip(PlyType type, std::uint64_t count) = 0;  // so many values of that type
  virtual void end_row() {}
  virtual void end() {}  // of the data: an ASCII file has no more lines
  // Says where the reader is and throws.
  [[noreturn]] virtual void fail(std::string_view what, std::string_view expected) const = 0;
};

// Whether what is skipped in ASCII has to be of the type that the header gives, or just a number.
enum class PlyTypes : std::uint8_t { as_written, enforced };

// `in` stands behind the header, and is of `file_size` bytes.
std::unique_ptr<PlyValues> ply_values(std::istream& in, std::string_view file, std::uintmax_t file_size,
                                      const PlyHeader& header, PlyTypes types = PlyTypes::as_written);

void skip_list(PlyValues& values, const PlyProperty& property);
void skip_element(PlyValues& values, const PlyElement& element);

}  // namespace splatscope::traces
