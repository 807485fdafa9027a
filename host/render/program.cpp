#include "program.h"

#include <fmt/format.h>

#include "passes_spirv_digest.h"
#include "version.h"

namespace vkvol {

std::string kernels_digest() {
    return passes_spirv_digest;
}

std::string program_text() {
    return fmt::format("{} (kernels {})", version, kernels_digest());
}

} // namespace vkvol
