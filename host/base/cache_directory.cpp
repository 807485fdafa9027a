#include "cache_directory.h"

#include <cstdlib>

namespace vkvol {

namespace {

std::filesystem::path environment_path(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

} // namespace

std::filesystem::path cache_home() {
    // "If an implementation encounters a relative path [...] it should consider the path invalid and ignore it."
    if (const std::filesystem::path xdg = environment_path("XDG_CACHE_HOME"); xdg.is_absolute())
        return xdg;
    const std::filesystem::path home = environment_path("HOME");
    return home.empty() ? home : home / ".cache";
}

std::filesystem::path cache_directory() {
    const std::filesystem::path home = cache_home();
    return home.empty() ? home : home / "vkvol";
}

} // namespace vkvol
