// How samples are spread about the middle of their pixel.
#pragma once

#include <vector>

#include "scene.h"

namespace vkvol {

// Quantiles of |x| for x spread as the filter weights, in pixels: what a part 1 - (1 - s)^2 lies within, for s = 0, 1 /
// count,
// ..., 1. They are dense where little is left, so that what falls off toward its rim does so between them, too; in s a
// tent's are even. The last is the radius.
std::vector<double> filter_quantiles(const RenderSettings& settings, int count);

} // namespace vkvol
