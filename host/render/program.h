// Which program renders: two of one version may still have other kernels.
#pragma once

#include <string>

namespace vkvol {

// Of all kernels within this program, 16 hexadecimal digits.
std::string kernels_digest();

// Version and kernels, as checkpoints have them.
std::string program_text();

} // namespace vkvol
