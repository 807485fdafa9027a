#pragma once

#include "shapes.h"

namespace reference {

// The ray through the point (x, y) of the picture, in pixels from its upper left corner: pixel (i, j) covers
// [i, i + 1) x [j, j + 1).
// (u, v) in [0, 1)^2: where it passes through the lens, if there is one.
Ray camera_ray(const vkvol::Camera& camera, const vkvol::Picture& picture, double x, double y, double u = 0.0,
               double v = 0.0);

// Where a rectangle that reads irradiance has a point of the picture, and the direction that it faces.
Ray rectangle_point(const vkvol::Camera& camera, const vkvol::Picture& picture, double x, double y);

// Distance from a pixel's middle, pixels, with (u, v) in [0, 1)^2, spread as the filter weights.
glm::dvec2 in_pixel(const vkvol::RenderSettings& settings, double u, double v);

} // namespace reference
