// Bounding volume hierarchies, as mesh.glsl and nearest.glsl walk them.
#pragma once

#include <limits>
#include <span>

#include "mesh.h"
#include "shared/frame.h"

namespace vkvol {

struct BvhBox {
    glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};

    void add(glm::vec3 p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void add(const BvhBox& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
};

// Nodes in depth-first order, each with the node to skip to; leaves name items by their place in `order`.
struct BoxTree {
    std::vector<shared::BvhNode> nodes;
    std::vector<std::uint32_t> order; // of the boxes given
};

// By the surface area heuristic. Throws InputError for more items than nodes can name.
BoxTree build_box_tree(std::span<const BvhBox> boxes);

// Hierarchy of a mesh's triangles. Boxes are exactly those of the single-precision vertices; what the traversal's own
// rounding asks for depends on the ray and is added there.
struct Bvh {
    std::vector<glm::vec3> triangles; // three corners each, render space
    std::vector<shared::BvhNode> nodes;
};

// `origin`: of render space, in world coordinates.
Bvh build_bvh(const Mesh& mesh, glm::dvec3 origin);

} // namespace vkvol
