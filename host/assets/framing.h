// Moves a camera so that what it looks at fills the picture.
#pragma once

#include <array>
#include <optional>

#include "density_field.h"
#include "field_cache.h"
#include "scene.h"

namespace vkvol {

using Corners = std::array<glm::dvec3, 8>; // of a box, world space

// Corners of the box that holds the grid's density.
Corners corners_of(const DensityField& field);

// Corners of the scene's medium; none without one, or if it holds nothing. Opens its files, and leaves a grid among
// `fields` for what comes next; throws InputError.
std::optional<Corners> medium_corners(const Scene& scene, FieldCache& fields);

glm::dvec3 middle_of(const Corners& corners);
double diagonal_of(const Corners& corners);

// What a lens has sharp stays where it is, after the camera has moved by that; throws InputError where it cannot.
void keep_focus(Camera& camera, const glm::dvec3& moved);

// Moves the camera, without turning it, to the nearest place from which the picture shows all corners with some air
// around them, but not up to the box itself; the box is in its middle. Focus is kept, and what that throws thrown.
void frame(Camera& camera, const Picture& picture, const Corners& corners);

// The same for the scene's medium. Throws InputError if there is none, too.
void frame_medium(Scene& scene, FieldCache& fields);

// Gives a scene without a camera the usual view of all its media, framed likewise. Returns one line that says which;
// empty where the scene has a camera, or nothing in it. Surfaces are framed where there are no media. Throws InputError
// for files that cannot be read.
std::string give_camera(Scene& scene, FieldCache& fields);

} // namespace vkvol
