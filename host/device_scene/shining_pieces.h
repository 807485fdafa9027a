// The pieces of surfaces that are lights, as looks choose among them: see shaders/lights/shining.glsl.
#pragma once

#include <map>
#include <vector>

#include "lights.h"
#include "surface_table.h"

namespace vkvol {

// Of one surface; all 0 of a mesh without triangles.
struct ShiningSurface {
    std::uint32_t first = 0, count = 0;  // of ShiningPieces::rows, one at least
    std::uint32_t sides = 1;             // that shine
    double area = 0.0;                   // of one side [world units^2]
    glm::vec3 low{0.0f}, high{0.0f};     // render space
    std::vector<std::uint32_t> pieces{}; // places in the table of primitives
};

struct ShiningPieces {
    std::vector<shared::EmitterRow> rows;   // each surface's in a table of its own, drawn from by area
    std::map<int, ShiningSurface> surfaces; // by body
};

ShiningPieces find_shining_pieces(const std::vector<Light>& lights, const SurfaceTable& surfaces);

} // namespace vkvol
