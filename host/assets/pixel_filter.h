// How samples are spread about the middle of their pixel.
#pragma once

#include <vector>

#include "scene.h"

namespace vkvol {

// A box as wide as the pixel, whose points need no table.
bool has_plain_pixels(const RenderSettings& settings);

// Of |x| for x spread as the filter weights: quantiles 0, 1 / count, ..., 1, in pixels; the last is the radius.
std::vector<double> filter_quantiles(const RenderSettings& settings, int count);

} // namespace vkvol
