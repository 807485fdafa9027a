// Where the camera's rays go, in the world and in double precision.
#pragma once

#include "scene.h"

namespace vkvol {

// The ray through the point (x, y) of the picture, in pixels from its left and top edge, starts at `position` and has
// the direction corner + x right + y down, which is 1 long along the view.
struct CameraRays {
    glm::dvec3 position;
    glm::dvec3 forward; // unit
    glm::dvec3 corner, right, down;

    glm::dvec3 direction(double x, double y) const { return corner + x * right + y * down; }
};

CameraRays camera_rays(const Camera& camera, const Picture& picture);

} // namespace vkvol
