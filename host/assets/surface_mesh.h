// Surfaces as they are in files.
#pragma once

#include <span>

#include "scene.h"

namespace vkvol {

// With triangles in place of files; of a dielectric, which has to know what it encloses, closed and turned
// outward. With textures' images. Throws InputError for a file that cannot be read, or that is not closed or has no
// places on a texture where it has to.
Scene with_surface_files(Scene scene);

// Planes, triangles and other shapes, one by one.
std::uint32_t pieces_of(std::span<const Surface> surfaces);

// Where all finite surfaces are, world space; none without any. Of meshes only once they are loaded.
struct SurfaceBounds {
    glm::dvec3 low, high;
};
std::optional<SurfaceBounds> bounds_of(std::span<const Surface> surfaces); // of planes there are none
// The distance from `origin` to the farthest corner.
double reach_of(const SurfaceBounds& bounds, const glm::dvec3& origin);

// The distance from `origin` to the end of what is farthest away; infinite for planes.
double reach_of_surfaces(std::span<const Surface> surfaces, const glm::dvec3& origin);

} // namespace vkvol
