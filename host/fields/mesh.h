// Closed triangle meshes from files: the shape of a medium that fills them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "polygons.h"
#include "scene.h"

namespace vkvol {

// Every edge is run through as often one way as the other, so that the number of surfaces a ray leaves less those it
// enters says how many bodies a point is inside of.
struct Mesh {
    std::vector<glm::dvec3> vertices;  // world space
    std::vector<glm::uvec3> triangles; // counterclockwise seen from without
    std::vector<glm::mat3> normals;    // of triangles' corners, as columns, as files have them; empty if one has none
    std::optional<Rgb> diffuse;        // Kd of the first face's material
    std::vector<std::string> warnings; // what was understood but is not honoured
    std::vector<std::string> normal_warnings;
};

// Welds equal positions and turns bodies that are inside out. InputError, with `name`, for what is not closed or
// encloses nothing.
void close_polygons(Polygons& polygons, const std::string& name);
// Those that no triangle has: a mesh ends where its faces do.
void drop_loose_vertices(std::vector<glm::dvec3>& vertices, std::vector<glm::uvec3>& triangles);
// For each vertex one at the same position, the same for all of them there.
std::vector<std::uint32_t> welded_vertices(const std::vector<glm::dvec3>& vertices);

// Three of each triangle, as single precision knows them from `origin`, world space.
std::vector<glm::vec3> corners_about(const Mesh& mesh, const glm::dvec3& origin);

// Reads all files, with the .mtl files they name beside them, and welds equal positions within each. Bodies that are
// inside out are turned. InputError for what is not closed, encloses nothing, or is not readable.
// `transform`: of all of them.
Mesh load_mesh(const MeshFiles& files, const glm::dmat4& transform = glm::dmat4(1.0));

} // namespace vkvol
