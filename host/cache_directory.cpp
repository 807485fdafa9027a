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
    if (const std::filesystem::path xdg = environment_path("XDG_CACHE_HOME"); !xdg.empty())
        return xdg;
    const std::filesystem::path home = environment_path("HOME");
    return home.empty() ? home : home / ".cache";
}

std::filesystem::path cache_directory() {
    const std::filesystem::path home = cache_home();
    return home.empty() ? home : home / "vkvol";
}

} // namespace vkvol
