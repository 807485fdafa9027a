// The surface that a ray meets first, or whether any is in its way. A search visits one node of the hierarchy per step, as that of
// a mesh does, so that a lane can lay it aside at any time.
#ifndef NEAREST_GLSL
#define NEAREST_GLSL
#include "surfaces/surface_point.glsl"

// `body`: the row of what is passed over, since it is the light that the ray goes to; or NO_SURFACE.
void take_nearer(MeshRay m, Ray ray, uint i, uint from, uint body, inout SurfaceSearch s) {
    float t = primitives[i].surface != body ? meet_primitive(m, ray, i, from) : FAR;
    s.primitive = t < s.nearest ? i : s.primitive;
    s.nearest = min(s.nearest, t);
}

// Of what is nearer than `reach`. Planes, which no hierarchy holds, are asked at once.
SurfaceSearch begin_seek(Ray ray, float reach, uint from) {
    SurfaceSearch s = SurfaceSearch(0u, reach, NO_SURFACE);
    for (uint i = 0u; i < frame.planes; ++i) { // at most MOST_PLANES
        float t = i != from ? meet_disk(ray, primitives[i].a, primitives[i].b, FAR) : FAR;
        bool nearer = t > 0.0 && t < s.nearest;
        s.primitive = nearer ? i : s.primitive;
        s.nearest = nearer ? t : s.nearest;
    }
    return s;
}

// One node: on to the next in depth-first order, or past its subtree. True once the search is over.
bool step_seek(MeshRay m, Ray ray, uint from, uint body, inout SurfaceSearch s) {
    if (s.node < frame.surface_nodes) {
        BvhNode node = bvh[frame.first_surface_node + s.node];
        bool met = meets(m, node, 0.0, s.nearest);
        uint first = node.leaf >> 3u, last = first + (met ? node.leaf & 7u : 0u);
        for (uint k = first; k < last; ++k) // at most MESH_LEAF
            take_nearer(m, ray, k, from, body, s);
        s.node = met && node.leaf == 0u ? s.node + 1u : node.skip;
    }
    return s.node >= frame.surface_nodes;
}

#endif
