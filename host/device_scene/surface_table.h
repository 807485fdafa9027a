// The surfaces of a scene as kernels know them.
#pragma once

#include <vector>

#include "bvh.h"
#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

struct SurfaceTable {
    std::vector<shared::SurfaceRow> rows;             // in the scene's order
    std::vector<shared::SurfacePrimitive> primitives; // planes first, then as leaves of the hierarchy name them
    std::vector<shared::BvhNode> nodes;
    std::uint32_t planes = 0;
    std::uint32_t met = 0; // the first of the primitives, which rays meet; behind them are their details
    std::vector<glm::vec4>
        texels; // of textures, each after a vec4 of its width (negative: nearest), height and repeats
};

// `origin`: of render space. `first_texel`: where those of textures will be.
SurfaceTable make_surface_table(const std::vector<Surface>& surfaces, const glm::dvec3& origin,
                                std::uint32_t first_texel = 0);

// About a piece that is no plane; render space.
BvhBox box_of(const shared::SurfacePrimitive& piece);

// World units^2; of a plane, none.
double area_of(const shared::SurfacePrimitive& piece);

// Bits of SPEC_MATERIALS.
int material_bits(const std::vector<Surface>& surfaces);

} // namespace vkvol
