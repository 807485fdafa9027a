#include "software_lanes.h"

#include <cstdlib>
#include <string_view>

namespace vkvol {

namespace {

bool has_sixteen_lanes() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

} // namespace

void take_all_lanes() {
    constexpr const char *width = "LP_NATIVE_VECTOR_WIDTH", *flags = "GALLIVM_PERF";
    if (!has_sixteen_lanes() || std::getenv(width) || std::getenv(flags))
        return;
    setenv(width, "512", 0);
    // The driver keeps code on disk for whoever asks next, by what these flags are and not by how many lanes it has.
    // This one is of textures with levels of detail, which no kernel has.
    setenv(flags, "no_quad_lod", 0);
}

std::string name_by_bits(std::string device_name) {
    constexpr std::string_view sixteen = ", 512 bits", eight = ", 256 bits";
    const std::size_t place = device_name.find(sixteen);
    if (device_name.starts_with("llvmpipe") && place != std::string::npos)
        device_name.replace(place, sixteen.size(), eight);
    return device_name;
}

} // namespace vkvol
