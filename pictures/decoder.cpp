#include "pictures/decoder.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

namespace splatscope::pictures {
namespace {

const Decoder& load() {
  const std::filesystem::path module =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / SPLATSCOPE_MODULE;
  void* library = ::dlopen(module.c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* entry = library != nullptr ? ::dlsym(library, "splatscope_picture_decoder") : nullptr;
  if (entry == nullptr) {
    const std::string reason = ::dlerror();
    if (!std::filesystem::exists(module))
      throw std::runtime_error(fmt::format("{}, expected it beside the program", reason));
    throw std::runtime_error(fmt::format("OpenImageIO's libraries could not be loaded: {}", reason));
  }
  return *reinterpret_cast<const Decoder* (*)()>(entry)();
}

}  // namespace

const Decoder& decoder() {
  static const Decoder& loaded = load();
  return loaded;
}

}  // namespace splatscope::pictures
