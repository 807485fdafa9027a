#include "demo_scene.h"

#include <fmt/format.h>

#include "error.h"

namespace vkvol {

std::filesystem::path demo_scene() {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    // bin/ beside share/, and build/ in the sources.
    for (const std::filesystem::path& home : {folder.parent_path() / "share" / "vkvol", folder.parent_path()}) {
        const std::filesystem::path scene = home / "scenes" / "cumulus.xml";
        const std::filesystem::path field = home / "density_fields" / "cumulus.nvdb";
        if (!std::filesystem::exists(scene, error))
            continue;
        if (!std::filesystem::exists(field, error))
            throw InputError(
                fmt::format("demo: {} is not there; in the sources, tools/demo.sh makes it", field.string()));
        return scene;
    }
    throw InputError(fmt::format("demo: there is no scene beside {}; it comes with an installed vkvol, and with its "
                                 "sources",
                                 folder.string()));
}

} // namespace vkvol
