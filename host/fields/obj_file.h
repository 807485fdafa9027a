// A Wavefront .obj file as it is written, before anything is asked of its shape.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene.h"

namespace vkvol {

struct ObjFile {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles; // of every polygon, in the order of the file
    std::optional<Rgb> diffuse;        // Kd of the first face's material
    bool several_diffuse = false;      // faces of another Kd follow
    std::vector<std::string> warnings; // material libraries that cannot be read
};

// InputError for a file that cannot be read, has no faces, a number that is none, or a vertex that does not exist.
ObjFile read_obj(const std::filesystem::path& path);

// The material libraries that it names, whether or not they are there. None if it cannot be read.
std::vector<std::filesystem::path> material_libraries(const std::filesystem::path& path);

} // namespace vkvol
