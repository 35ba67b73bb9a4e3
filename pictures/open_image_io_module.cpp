#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <stdexcept>

#include "pictures/codec.h"

// The module: all that knows OpenImageIO.
namespace splatscope::pictures {
namespace {

OIIO::ImageSpec spec_of(const std::string& ending, const Picture& picture) {
  const bool png = ending == ".png";
  OIIO::ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                       static_cast<int>(picture.channels),
                       png ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
  if (png) {
    spec.attribute("oiio:ColorSpace", "sRGB");  // shown as it is, like a frame buffer of 2002
  } else {
    // Without a date of its own the library writes that of today, and no two runs would give the same file.
    spec.attribute("DateTime", "");
  }
  if (!picture.channel.empty()) spec.channelnames = {picture.channel};
  if (picture.channel == "Z") spec.z_channel = 0;
  return spec;
}

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

class OpenImageIo : public Codec {
 public:
  // In memory: the library does not notice where a disk is full.
  std::vector<std::byte> encode(const std::string& ending, const Picture& picture,
                                bool (*asked_to_stop)()) const override {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput proxy(bytes);
    const std::string name = "picture" + ending;
    const auto out = OIIO::ImageOutput::create(name, &proxy);
    const auto progress = [](void* asked, float) { return (*static_cast<bool (**)()>(asked))(); };
    if (!out || !out->open(name, spec_of(ending, picture)) ||
        !out->write_image(OIIO::TypeDesc::FLOAT, picture.values,
                          static_cast<OIIO::stride_t>(picture.pixel_stride * sizeof(float)), OIIO::AutoStride,
                          OIIO::AutoStride, progress, static_cast<void*>(&asked_to_stop)) ||
        !out->close()) {
      const std::string why = out ? out->geterror() : OIIO::geterror();
      throw std::runtime_error("a picture could not be made: " +
                               (why.empty() ? "OpenImageIO tells no reason" : why));
    }
    if (asked_to_stop()) return {};  // it calls a picture written that it was told to give up
    const auto all = std::as_bytes(std::span(bytes));
    return {all.begin(), all.end()};
  }

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

extern "C" const splatscope::pictures::Codec* splatscope_picture_codec() {
  static const splatscope::pictures::OpenImageIo codec;
  return &codec;
}
