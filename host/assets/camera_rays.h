// Where the camera's rays go, in the world and in double precision.
#pragma once

#include "crop.h"
#include "scene.h"

namespace vkvol {

// The ray through the point (x, y) of the picture, in pixels from its left and top edge, and the middle of the lens.
// Perspective: it starts at `position` and has the direction corner + x right + y down, which is 1 long along the view.
// Orthographic: it starts at position + corner + x right + y down and goes forward; so it does from a rectangle that
// reads irradiance, along whose normal that is. Equirectangular: it starts at
// `position` at angles first_angle + (x, y) * angle_step (radians: longitude to the right of `forward`, latitude);
// right and down are unit vectors then.
struct CameraRays {
    Projection projection;
    glm::dvec3 position;
    glm::dvec3 forward; // unit
    glm::dvec3 corner, right, down;
    glm::dvec2 first_angle, angle_step;

    glm::dvec3 origin(double x, double y) const;
    glm::dvec3 direction(double x, double y) const;
    double pixel_at(double distance) const; // world units: how high a pixel is, at that distance
};

CameraRays camera_rays(const Camera& camera, const Picture& picture);

// The box about the rectangle of a sensor that reads irradiance, or that in which absorption is read; world.
struct SensorBox {
    glm::dvec3 low, high;
};
SensorBox sensor_box(const Camera& camera, const Picture& picture);

// Where a sensor of flux reads each pixel of the window, row by row, world; empty of cameras.
std::vector<glm::dvec3> reading_places(const Camera& camera, const Picture& picture, const Crop& window);

} // namespace vkvol
