#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>

#include "pictures/decoder.h"

// The module: all that knows OpenImageIO.
namespace splatscope::pictures {
namespace {

template <class Value>
std::optional<Decoded<Value>> read(const Source& source, std::size_t most_channels, std::size_t most_side,
                                   const OIIO::TypeDesc& type, std::string* why) {
  why->clear();
  std::optional<OIIO::Filesystem::IOMemReader> memory;
  if (source.bytes)  // only read
    memory.emplace(const_cast<std::byte*>(source.bytes->data()), source.bytes->size());
  OIIO::ImageSpec as_stored;
  as_stored.attribute("oiio:UnassociatedAlpha", 1);  // else colours come multiplied by their alpha
  OIIO::Filesystem::IOProxy* proxy = memory ? &*memory : nullptr;
  if (proxy)
    as_stored.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR,
                        static_cast<const void*>(&proxy));  // also asked of the configuration
  const auto input = OIIO::ImageInput::open(source.name, &as_stored, proxy);
  if (!input) {
    OIIO::geterror();  // else the library prints it at exit
    return std::nullopt;
  }
  const OIIO::ImageSpec& spec = input->spec();
  const auto most = static_cast<int>(most_side);
  if (spec.width < 1 || spec.height < 1 || spec.width > most || spec.height > most || spec.depth > 1 ||
      spec.nchannels < 1) {
    *why = "of a size or depth that is not read";
    return std::nullopt;
  }
  const int channels = std::min(spec.nchannels, static_cast<int>(most_channels));
  Decoded<Value> decoded{static_cast<std::size_t>(spec.width),
                         static_cast<std::size_t>(spec.height),
                         static_cast<std::size_t>(channels),
                         {}};
  decoded.values.resize(decoded.width * decoded.height * decoded.channels);
  if (!input->read_image(0, 0, 0, channels, type, decoded.values.data())) {
    *why = input->geterror();
    return std::nullopt;
  }
  return decoded;
}

class OpenImageIo : public Decoder {
 public:
  std::optional<Decoded<float>> read_floats(const Source& source, std::size_t most_channels,
                                            std::size_t most_side, std::string* why) const override {
    return read<float>(source, most_channels, most_side, OIIO::TypeDesc::FLOAT, why);
  }
  std::optional<Decoded<std::uint8_t>> read_bytes(const Source& source, std::size_t most_channels,
                                                  std::size_t most_side, std::string* why) const override {
    return read<std::uint8_t>(source, most_channels, most_side, OIIO::TypeDesc::UINT8, why);
  }
};

}  // namespace
}  // namespace splatscope::pictures

extern "C" const splatscope::pictures::Decoder* splatscope_picture_decoder() {
  static const splatscope::pictures::OpenImageIo decoder;
  return &decoder;
}
