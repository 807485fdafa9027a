// What closed triangle meshes enclose.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "shapes.h"

namespace reference {

struct Mesh {
    std::vector<std::array<glm::dvec3, 3>> triangles; // world space, counterclockwise seen from without
    std::optional<vkvol::Rgb> diffuse;                // Kd of the first material, if there is any
};

// Reads .obj files, polygons cut into triangles. A file whose surfaces enclose a negative volume is turned inside out.
// Throws std::runtime_error.
Mesh load_mesh(const vkvol::MeshFiles& files);

// The parts of the whole line, t < 0 included, where the winding number is positive: the union of the bodies, less the
// cavities that inward surfaces cut out of their own. In order; none of them empty.
std::vector<Interval> intersect(const Mesh& mesh, const Ray& ray);

} // namespace reference
