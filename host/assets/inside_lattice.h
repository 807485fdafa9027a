// Whether a point is within a mesh, by one look-up: where several media are in one another, walks go through the sum of
// all and know no faces. See shaders/field/inside.glsl.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "majorant_grid.h"

namespace vkvol {

// Cubes over the box around a mesh. Those that no triangle reaches into are within or without; each of the others has a
// point of which it is known how many bodies it is within, and the triangles of which some may lie between that point
// and others of the cube.
struct InsideLattice {
    glm::dvec3 low{0.0}; // where the cubes begin, medium space
    double edge = 1.0;   // of a cube
    MajorantGrid cells;  // of one cube each: 1 where some of it may be within, else 0
    // INSIDE_HEAD words; an entry per cube: 0 without, 1 within, or where its record begins, counted from the head;
    // records: number of triangles, number of bodies, the point, the triangles; then three corners of each triangle.
    std::vector<std::uint32_t> words;
    std::uint32_t longest = 0; // triangles of a record
};

// `triangles`: three corners each, in medium space, of surfaces that are closed. Throws InputError where so many
// triangles meet that look-ups would be endless.
InsideLattice make_inside_lattice(std::span<const glm::vec3> triangles);

} // namespace vkvol
