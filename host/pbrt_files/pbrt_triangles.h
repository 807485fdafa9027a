// The triangles of pbrt's meshes that stand in its scene files, and what they make up.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "pbrt_scene.h"

namespace vkvol {

struct PbrtTriangles {
    std::vector<glm::dvec3> points;
    std::vector<glm::uvec3> triangles;
    std::vector<glm::dvec3> normals; // of points; or empty
    std::vector<glm::dvec2> places;  // of points, on textures; or empty

    double area() const;
    bool is_even(int each) const; // all `each` triangles in a row have the same area

private:
    double area_of(std::size_t begin, std::size_t end) const;
};

// Triangles of a "trianglemesh" or "bilinearmesh", in the shape's own space. Four-cornered patches become two triangles
// each. Throws InputError for indices of no point, and other counts that do not fit.
PbrtTriangles read_triangles(const PbrtThing& shape);

// Where pbrt has corners on textures that a shape says nothing of: at (0, 0), (1, 0) and (1, 1) of each triangle, and
// of each of the halves of `is_patches`, (0, 0), (1, 1) and (0, 1). No two triangles share a corner then.
PbrtTriangles with_usual_places(const PbrtTriangles& mesh, bool is_patches);

// What is right of `map` moves them; a mirror, or `is_reversed`, turns their order about so that their front stays in
// front, or goes to the back. Where there are normals, the front is on their side, as in pbrt.
PbrtTriangles moved(const glm::dmat4& map, PbrtTriangles mesh, bool is_reversed);

struct PbrtRectangle {
    glm::dvec3 center;
    glm::dvec3 edge_u, edge_v; // whole edges; their cross product points to the front
};

// Whether normals at corners say no more than that faces are flat.
bool has_normals_of_faces(const PbrtTriangles& mesh);

// If they are two triangles that make one.
std::optional<PbrtRectangle> as_rectangle(const PbrtTriangles& mesh);

// If they are the twelve of a box: from the unit cube about the origin, right-handed.
std::optional<glm::dmat4> as_box(const PbrtTriangles& mesh);

} // namespace vkvol
