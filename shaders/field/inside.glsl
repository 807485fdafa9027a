// Whether a point is within a mesh, one of several media: by the bodies that a point of its cube is known to be within, and the
// faces between the two. What is read here is laid out in host/assets/inside_lattice.h.
#ifndef INSIDE_GLSL
#define INSIDE_GLSL
#include "majorants/cells.glsl"
#include "shapes/mesh.glsl"

#ifdef SEVERAL
vec3 overlap_vec3(uint i) {
    return uintBitsToFloat(uvec3(overlap_word(i), overlap_word(i + 1u), overlap_word(i + 2u)));
}

// `head`: where the mesh's words begin. `p`: in its medium space.
bool inside_mesh(uint head, vec3 p) {
    ivec3 dims = ivec3(overlap_word(head + INSIDE_DIMS), overlap_word(head + INSIDE_DIMS + 1u), overlap_word(head + INSIDE_DIMS + 2u));
    vec3 at = floor((p - overlap_vec3(head)) * uintBitsToFloat(overlap_word(head + INSIDE_PER_UNIT)));
    ivec3 cell = ivec3(clamp(at, vec3(0.0), vec3(dims - 1)));
    uint entry = overlap_word(head + INSIDE_HEAD + cell_index(cell, dims));
    bool listed = entry > 1u;
    uint record = head + (listed ? entry : 0u);
    uint count = listed ? overlap_word(record) : 0u;
    int bodies = listed ? int(overlap_word(record + 1u)) : int(entry);
    vec3 known = overlap_vec3(record + 2u);
    Shear shear = make_shear(Ray(p, known - p));
    shear.scale = scale_up(uintBitsToFloat(overlap_word(head + INSIDE_REACH)));
    uint corners = head + overlap_word(head + INSIDE_CORNERS);
    for (uint k = 0u; k < count; ++k) {
        uint i = corners + 9u * overlap_word(record + 5u + k);
        Crossing crossing = cross_triangle(shear, overlap_vec3(i), overlap_vec3(i + 3u), overlap_vec3(i + 6u));
        bodies += crossing.t > 0.0 && crossing.t < 1.0 ? crossing.turn : 0;
    }
    // Beyond the cubes there is nothing.
    return bodies > 0 && all(greaterThanEqual(at, vec3(0.0))) && all(lessThan(at, vec3(dims)));
}
#endif

#endif
