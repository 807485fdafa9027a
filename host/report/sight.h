// What the camera has before it: where its rays meet the medium, and how much of it.
#pragma once

#include "camera_rays.h"
#include "crop.h"
#include "medium_outline.h"

namespace vkvol {

struct Sight {
    double entering = 0.0;         // part of the rays of this window that enter the medium's ball or box
    double entering_picture = 0.0; // of the whole picture's, where this is a crop
    double entering_frame = 0.0;   // of the reference frame's, of which the picture is a part
    bool in_window = false;        // a ray of this window may enter, though none of the lattice's does
    double most_depth = 0.0;       // optical depth along these rays, at most
    double least_depth = 0.0;
    bool inside = false; // the camera, of the ball or box
    WorldBox box{};
    glm::dvec3 eye{0.0}, forward{0.0};
    double degrees_off = 0.0; // from the middle of the view to that of the medium
    double pixels = 0.0;      // diameter of the medium in pixels; 0 from within
};

// By rays on a lattice over the window, some hundreds of them. Expects a medium that exists.
Sight sight_of(const Scene& scene, const MediumOutline& outline, const Crop& crop);

} // namespace vkvol
