// vkvol convert SCENE.pbrt -o SCENE.xml: what of a scene of pbrt-v4 was understood, as a scene file to go on from.
#pragma once

#include "options.h"

namespace vkvol {

int run_convert(const ConvertOptions& options);

} // namespace vkvol
