#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

// Picture files of any format by OpenImageIO, which is loaded when it is first asked for.
namespace splatscope::pictures {

// Rows from the top, channels of a pixel side by side.
template <class Value>
struct Decoded {
  std::size_t width = 0, height = 0, channels = 0;
  std::vector<Value> values;
};

struct Source {
  std::string name;                                      // the file; of one in memory only its ending is read
  std::optional<std::span<const std::byte>> bytes = {};  // of a file in memory
};

class Decoder {
 public:
  virtual ~Decoder() = default;
  // The first channels, `most_channels` of them at most. Nothing where it is no picture, or larger than
  // `most_side`; then `*why` is what the library says, empty where it could not open the file.
  virtual std::optional<Decoded<float>> read_floats(const Source& source, std::size_t most_channels,
                                                    std::size_t most_side, std::string* why) const = 0;
  virtual std::optional<Decoded<std::uint8_t>> read_bytes(const Source& source, std::size_t most_channels,
                                                          std::size_t most_side, std::string* why) const = 0;
};

// Throws std::runtime_error where the module does not lie beside the program, or does not load.
const Decoder& decoder();

}  // namespace splatscope::pictures
