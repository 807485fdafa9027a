#pragma once

#include "shapes.h"

namespace reference {

// The ray through the point (x, y) of the picture, in pixels from its upper left corner: pixel (i, j) covers
// [i, i + 1) x [j, j + 1).
Ray camera_ray(const vkvol::Camera& camera, const vkvol::Picture& picture, double x, double y);

} // namespace reference
