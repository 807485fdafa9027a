// Where lines are inside of bodies, in double precision.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh.h"

namespace vkvol {

struct Line {
    glm::dvec3 origin;
    glm::dvec3 direction; // unit
};

// A convex body: the half spaces dot(normal, x) <= offset.
struct Convex {
    std::vector<glm::dvec4> planes; // unit normal, offset
};

Convex convex_box(glm::dvec3 low, glm::dvec3 high);

// The body within a convex mesh, whose faces look outward.
Convex convex_hull(const Mesh& mesh);

// Length of the part of the line from its origin on in the union of bodies that are grown by `margin` on all sides.
double chord(const std::vector<Convex>& bodies, const Line& line, double margin);

struct Crossing {
    double t;
    int turn; // +1 where the line leaves, -1 where it enters
};

// By every triangle in turn (three corners each), in order of t > 0. `unsure` is set for lines that pass so near an
// edge, or so flat along a face, that a displacement by `margin` may change more than the crossings' places.
std::vector<Crossing> find_crossings(std::span<const glm::vec3> triangles, const Line& line, double margin,
                                     bool& unsure);

double inside_length(const std::vector<Crossing>& crossings);

} // namespace vkvol
