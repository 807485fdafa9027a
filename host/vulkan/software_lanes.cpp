#include "software_lanes.h"

#include <cstdlib>

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

} // namespace vkvol
