// Closed meshes of known shape.
#pragma once

#include <string>

#include "mesh.h"

namespace vkvol {

// n x n squares per face, each of two triangles; every face has vertices of its own.
Mesh make_box(glm::dvec3 low, glm::dvec3 high, int n);

// 20 * 4^level triangles, their corners on the unit sphere.
Mesh make_icosphere(int level);

// About the z axis: n * m squares, each of two triangles.
Mesh make_torus(double major, double minor, int n, int m);

// The letter's legs are [0, 2] x [0, 1] and [0, 1] x [0, 2]; thickness 1.
Mesh make_letter_l();

Mesh join(Mesh a, const Mesh& b);

// The text of its .obj file.
std::string as_obj(const Mesh& mesh);

// The bytes of its .ply file; coordinates as double.
enum class PlyFormat { ascii, little_endian, big_endian };
std::string as_ply(const Mesh& mesh, PlyFormat format);

} // namespace vkvol
