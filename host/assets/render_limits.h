// What can be read but not rendered: media that no patience suffices for, and figures beyond single precision.
#pragma once

#include "loaded_medium.h"

namespace vkvol {

// Throws InputError with the figure and the remedy.
void check_limits(const Scene& scene, const Volume& volume, const LoadedMedium& loaded, const Method& method);

// What is rendered, but not well: mean free paths that are hardly more than places are known to. Empty: none.
std::string too_short_paths(const Scene& scene, const Volume& volume, const LoadedMedium& loaded);

} // namespace vkvol
