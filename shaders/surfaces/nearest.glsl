// The surface that a ray meets first, or whether any is in its way. A search visits one node of the hierarchy per step, as that of
// a mesh does, so that a lane can lay it aside at any time.
#ifndef NEAREST_GLSL
#define NEAREST_GLSL
#include "surfaces/surface_point.glsl"

// Whether the light, or sensor, at the end of the ray lies in what the ray meets at `t`, as far as rounding can tell: by an eighth
// of what places on surfaces are kept apart by. Rays that run along what is far larger than they are long meet it anywhere.
bool lies_in(uint i, Ray ray, float t, float reach) {
    SurfacePoint at = surface_point(i, ray.origin + t * ray.direction);
    return (reach - t) * abs(dot(at.normal, ray.direction)) <= 0.125 * at.apart;
}

// `body`: the row of what is passed over, since it is the light that the ray goes to; or NO_SURFACE.
void take_nearer(MeshRay m, Ray ray, uint i, uint from, uint body, inout SurfaceSearch s) {
    SurfacePrimitive p = primitive_at(i);
    float t = p.surface != body ? meet_primitive(m, ray, p, i, from) : FAR;
    s.primitive = t < s.nearest ? i : s.primitive;
    s.nearest = min(s.nearest, t);
}

// Begins the search for what is nearer than `reach`. Planes, which no hierarchy holds, are asked at once.
SurfaceSearch begin_seek(Ray ray, float reach, uint from) {
    SurfaceSearch s = SurfaceSearch(0u, reach, NO_SURFACE);
    for (uint i = 0u; i < frame.planes; ++i) { // at most MOST_PLANES
        SurfacePrimitive p = primitive_at(i);
        float t = i != from ? meet_disk(ray, p.a, p.b, FAR) : FAR;
        bool nearer = t > 0.0 && t < s.nearest;
        s.primitive = nearer ? i : s.primitive;
        s.nearest = nearer ? t : s.nearest;
    }
    return s;
}

BvhNode surface_node(uint i) {
#ifdef SURFACES
    if (TABLE_TEXELS != 0) {
        uvec4 a = texelFetch(node_texels, int(2u * i)), b = texelFetch(node_texels, int(2u * i + 1u));
        return BvhNode(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w);
    }
#endif
    return bvh[i];
}

#ifdef RAY_QUERY
// Of two pieces that are met at one distance the first, as the tree has it, whatever order the device asks them in.
void take_nearer_of_any(MeshRay m, Ray ray, uint i, uint from, uint body, inout SurfaceSearch s) {
    SurfacePrimitive p = primitive_at(i);
    float t = p.surface != body ? meet_primitive(m, ray, p, i, from) : FAR;
    bool nearer = t < s.nearest || (t == s.nearest && s.primitive != NO_SURFACE && i < s.primitive);
    s.primitive = nearer ? i : s.primitive;
    s.nearest = nearer ? t : s.nearest;
}

// The whole search, by the device: it finds boxes of pieces that the ray may be in, and whether a piece is met is found as a
// search of the tree finds it. `looks`: whether anything is in the way will do. `reach`: how far a light is that what it lies in
// does not hide, or FAR.
void ask_boxes(MeshRay m, Ray ray, uint from, uint body, bool looks, float reach, inout SurfaceSearch s) {
    rayQueryEXT query;
    // Looks at what is as near as rounding may end before they begin, which no query may.
    rayQueryInitializeEXT(query, boxes_of_pieces, gl_RayFlagsNoneEXT, 0xFFu, ray.origin, 0.0, ray.direction, max(s.nearest, 0.0));
    bool going = s.nearest > 0.0 && !(looks && s.primitive != NO_SURFACE);
    while (going && rayQueryProceedEXT(query)) {
        SurfaceSearch before = s;
        take_nearer_of_any(m, ray, frame.planes + uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false)), from, body, s);
        if (s.primitive != before.primitive) {
            if (looks && reach < FAR && lies_in(s.primitive, ray, s.nearest, reach))
                s = before;
            else
                rayQueryGenerateIntersectionEXT(query, s.nearest);
            going = !(looks && s.primitive != NO_SURFACE);
        }
    }
}
#endif

// One node: on to the next in depth-first order, or past its subtree. True once the search is over.
bool step_seek(MeshRay m, Ray ray, uint from, uint body, inout SurfaceSearch s) {
    if (s.node < frame.surface_nodes) {
        BvhNode node = surface_node(frame.first_surface_node + s.node);
        bool met = meets(m, node, 0.0, s.nearest);
        uint first = node.leaf >> 3u, last = first + (met ? node.leaf & 7u : 0u);
        for (uint k = first; k < last; ++k) // at most MESH_LEAF
            take_nearer(m, ray, k, from, body, s);
        s.node = met && node.leaf == 0u ? s.node + 1u : node.skip;
    }
    return s.node >= frame.surface_nodes;
}

#endif
