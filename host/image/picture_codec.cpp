#include "picture_codec.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "error.h"

namespace vkvol {

namespace {

const PictureCodec* load() {
    void* const library =
        dlopen(VKVOL_CODEC_FILE, RTLD_LAZY | RTLD_LOCAL); // beside what was built, or as it is installed
    const auto offer =
        library ? reinterpret_cast<decltype(&vkvol_picture_codec)>(dlsym(library, "vkvol_picture_codec")) : nullptr;
    if (!offer)
        throw RenderError(fmt::format("pictures can be neither read nor written: {}; install vkvol again", dlerror()));
    return offer();
}

} // namespace

const PictureCodec& picture_codec() {
    static const PictureCodec* const codec = load();
    return *codec;
}

std::future<void> picture_codec_ahead() {
    // Deferred, and never done, where no thread can be made.
    return std::async(std::launch::async | std::launch::deferred, [] { picture_codec(); });
}

} // namespace vkvol
