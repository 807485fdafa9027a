// Grids of values in a box, as OpenVDB's files have them.
#pragma once

#include <string>
#include <vector>

#include "memory_grids.h"

namespace vkvol {

struct BoxGrid {
    std::string name;
    glm::ivec3 dims{1};
    std::vector<glm::vec3> colors; // x fastest and then y
    GridPlace place = {};

    bool is_grey() const; // all channels are alike: it is one of numbers
};

// As the bytes of a .vdb file; what is 0 is left out, but for the corners. Throws RenderError.
std::string vdb_file_of(const std::vector<BoxGrid>& grids);
// As those of an .nvdb file.
std::string nvdb_file_of(const std::vector<BoxGrid>& grids);

} // namespace vkvol
