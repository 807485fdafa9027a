// A mesh as its file says it, before anything is asked of its shape.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene.h"

namespace vkvol {

struct Polygons {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;        // of every polygon, in the order of the file
    std::vector<glm::mat3> normals;           // of the triangles' corners, as columns, as written; or empty
    std::vector<glm::mat3x2> places;          // likewise, on a texture
    std::optional<Rgb> diffuse;               // Kd of the first face's material
    bool several_diffuse = false;             // faces of another Kd follow
    std::vector<std::string> warnings;        // material libraries that cannot be read
    std::vector<std::string> place_warnings;  // of concern to who lays a texture on it,
    std::vector<std::string> normal_warnings; // and to who takes its normals
};

// From a .ply or .ply.gz file, or whatever it is called a Wavefront .obj. InputError for a file that cannot be read,
// has no faces, a number that is none, or a vertex that does not exist.
Polygons read_polygons(const std::filesystem::path& path);

// The whole file, unpacked if gzip has packed it; InputError if that cannot be.
std::string read_mesh_text(const std::filesystem::path& path);

} // namespace vkvol
