// Small maps of the sky.
#pragma once

#include <functional>

#include "lights.h"
#include "radiance_map.h"

namespace vkvol {

// `radiance` of column and row.
RadianceMap make_map(int width, int height, const std::function<Rgb(int, int)>& radiance);

// A ground, a horizon and a bright corner of the sky, in colours.
RadianceMap sunset_map();

// Square: bright from one side, dark below, in colours; with bright texels at two edges, beside others over the
// fold.
RadianceMap square_map();

} // namespace vkvol
