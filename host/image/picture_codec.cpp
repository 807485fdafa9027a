#include "picture_codec.h"

#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>

#include "error.h"

namespace vkvol {

namespace {

void* open_library() {
    if (void* const library =
            dlopen(VKVOL_CODEC_FILE, RTLD_LAZY | RTLD_LOCAL)) // by the RUNPATH of what holds this code
        return library;
    // Which is the sanitizer's where one stands before dlopen: then beside the program, or where Python's module was
    // built.
    std::error_code ignored;
    Dl_info own{};
    dladdr(reinterpret_cast<const void*>(&picture_codec), &own);
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored),
                                module = own.dli_fname ? own.dli_fname : "";
    for (const std::filesystem::path& folder : {program.parent_path(), module.parent_path() / "../.."})
        if (void* const library = dlopen((folder / VKVOL_CODEC_FILE).c_str(), RTLD_LAZY | RTLD_LOCAL))
            return library;
    return nullptr;
}

const PictureCodec* load() {
    void* const library = open_library();
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
