// The surfaces of a scene as kernels know them.
#pragma once

#include <vector>

#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

struct SurfaceTable {
    std::vector<shared::SurfaceRow> rows;             // in the scene's order
    std::vector<shared::SurfacePrimitive> primitives; // planes first, then as leaves of the hierarchy name them
    std::vector<shared::BvhNode> nodes;
    std::uint32_t planes = 0;
    std::uint32_t met = 0; // the first of the primitives, which rays meet; behind them are normals
};

// `origin`: of render space. Throws InputError if there are too many.
SurfaceTable make_surface_table(const std::vector<Surface>& surfaces, const glm::dvec3& origin);

// Bits of SPEC_MATERIALS.
int material_bits(const std::vector<Surface>& surfaces);

} // namespace vkvol
