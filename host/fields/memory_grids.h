// Grids that are in no file.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
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

// Of a box of values, x fastest and then y, at (0, 0, 0) to dims - 1 of index space, which is also its world; those
// that are 0 take no memory. Throws InputError if it cannot be built.
GridBytes make_grid(const std::string& name, glm::ivec3 dims, const std::vector<float>& values);

// As the bytes of an .nvdb file.
std::string nvdb_file_of(const MemoryGrids& grids);

} // namespace vkvol
