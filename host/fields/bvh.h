// Bounding volume hierarchy over a mesh's triangles, as mesh.glsl walks it.
#pragma once

#include "mesh.h"
#include "shared/frame.h"

namespace vkvol {

// Nodes in depth-first order, each with the node to skip to. Boxes are exactly those of the single-precision vertices;
// what the traversal's own rounding asks for depends on the ray and is added there.
struct Bvh {
    std::vector<glm::vec3> triangles; // three corners each, render space
    std::vector<shared::BvhNode> nodes;
};

// `origin`: of render space, in world coordinates.
Bvh build_bvh(const Mesh& mesh, glm::dvec3 origin);

} // namespace vkvol
