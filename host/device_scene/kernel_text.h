// What the kernels were compiled for, in words.
#pragma once

#include <string>

#include "loaded_medium.h"
#include "specialization.h"

namespace vkvol {

std::string kernel_text(const Specialization& specialization, const Assets& assets, bool chromatic);

} // namespace vkvol
