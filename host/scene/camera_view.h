// Where a camera looks: its angles, and those that make it look at a point.
#pragma once

#include "scene.h"

namespace vkvol {

// Rz(roll) * Ry(yaw) * Rx(pitch): columns are the camera's right, up and back in world space.
glm::dmat3 camera_rotation(const Camera& camera);

// As scene files have it.
const char* projection_name(Projection projection);

// Turns the camera to look along `forward`, with `up` upwards in the picture. They may have any length, and must not be
// parallel.
void look_along(Camera& camera, glm::dvec3 forward, glm::dvec3 up);

// Are these so nearly parallel that the picture could be turned any way?
bool is_parallel(glm::dvec3 forward, glm::dvec3 up);

// Stops by which radiance is to be raised so that what saturates the film is white: a luminance of 1.2 N^2 / t 100 / S,
// of f-number N, time t and speed S (ISO 12232, by saturation, for a lens that lets 0.65 through: Lagarde and de
// Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 5.1).
double stops_of(const Exposure& exposure);

// A circle around a target: at azimuth 0 and elevation 0 the camera is at +z of it and looks along -z; azimuth turns it
// counter-clockwise as seen from above, elevation lifts it. Where `up` is not y, all of that is turned along, by the
// shortest way; for up = z, azimuth 0 is at -y.
struct Orbit {
    glm::dvec3 target{0.0};
    double distance = 1.0;
    double azimuth = 0.0, elevation = 0.0; // degrees
    glm::dvec3 up{0.0, 1.0, 0.0};          // of any length but 0
};

void place_on_orbit(Camera& camera, const Orbit& orbit);

// The usual view, somewhat from the side and above [degrees].
inline constexpr double usual_azimuth = 30.0, usual_elevation = 12.0, usual_fov = 30.0;

// The part of the image plane at distance 1 that the picture shows, camera space: x to the right, y upwards.
// Orthographic: as if the reference frame were two world units high.
struct ViewWindow {
    double left, right, bottom, top;
};

ViewWindow view_window(const Camera& camera, const Picture& picture);

} // namespace vkvol
