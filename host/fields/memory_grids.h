// Grids that are in no file.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "nvdb_file.h"

namespace vkvol {

struct MemoryGrids {
    struct Grid {
        std::string name;
        GridBytes bytes;
    };
    std::vector<Grid> grids;

    const GridBytes* find(const std::string& name) const; // null: there is none
};

// By the names of files that they stand for.
using NamedGrids = std::map<std::string, std::shared_ptr<const MemoryGrids>>;

// Where in the world a grid's index space lies, axes along axes.
struct GridPlace {
    glm::dvec3 voxel_size{1.0}; // > 0
    glm::dvec3 origin{0.0};     // of the middle of voxel (0, 0, 0)
};

// Makes a grid of a box of values, x fastest and then y, at (0, 0, 0) to dims - 1 of index space; those that are 0 take
// no memory.
GridBytes make_grid(const std::string& name, glm::ivec3 dims, std::span<const float> values,
                    const GridPlace& place = {});
GridBytes make_grid(const std::string& name, glm::ivec3 dims, std::span<const glm::vec3> colors,
                    const GridPlace& place = {});

// As the bytes of an .nvdb file.
std::string nvdb_file_of(const MemoryGrids& grids);

} // namespace vkvol
