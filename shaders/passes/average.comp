// The medium's density around each node of the lattice: the mean over eight points of the cell about it, one in each octant.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "field/superposition.glsl"
#include "lights/lattice.glsl"
#include "lib/rng.glsl"

void main() {
    uint i = push.node_begin + gl_GlobalInvocationID.x;
    LatticeParams l = frame.lattice;
    if (i >= uint(l.dims.x * l.dims.y * l.dims.z))
        return;
    ivec3 node = lattice_node(i);
    float sum = 0.0;
    for (uint octant = 0u; octant < 8u; ++octant) {
        uvec4 words = pcg4d(uvec4(i, octant, 0u, 0u));
        vec3 corner = vec3(octant & 1u, octant >> 1u & 1u, octant >> 2u);
        vec3 p = node_position(node) + (0.5 * (corner + to_uniform(words).xyz) - 0.5) * l.spacing;
        bool inside = SHAPE != SHAPE_SPHERE || dot(p, p) < 1.0;
        float found = density(frame.media[0], p, to_tap(pcg4d(words)));
        sum += inside ? found : 0.0;
    }
    store_node(LATTICE_DENSITY, node, 0.125 * sum);
}
