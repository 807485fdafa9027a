// A value at every node of a lattice over the medium's box, interpolated linearly in between. A node's entry holds its own
// value and those of its neighbours along y, z and both, so that two entries make the eight corners of a cell.
#ifndef LATTICE_GLSL
#define LATTICE_GLSL
#include "lib/buffers.glsl"

#define LATTICE_DENSITY 0u // mean around each node
#define LATTICE_DEPTH 1u   // and on: optical depths, of the channel where extinction is largest

uint lattice_index(uint which, ivec3 node) {
    ivec3 dims = frame.lattice.dims;
    return which * uint(dims.x * dims.y * dims.z) + uint((node.x * dims.y + node.y) * dims.z + node.z);
}

ivec3 lattice_node(uint i) {
    ivec3 dims = frame.lattice.dims;
    return ivec3(int(i) / (dims.y * dims.z), int(i) / dims.z % dims.y, int(i) % dims.z);
}

vec3 node_position(ivec3 node) {
    return frame.lattice.low + vec3(node) * frame.lattice.spacing;
}

// Into the entries of the node itself and of those before it.
void store_node(uint which, ivec3 node, float value) {
    lattice[lattice_index(which, node)].x = value;
    if (node.z > 0)
        lattice[lattice_index(which, node - ivec3(0, 0, 1))].y = value;
    if (node.y > 0)
        lattice[lattice_index(which, node - ivec3(0, 1, 0))].z = value;
    if (node.y > 0 && node.z > 0)
        lattice[lattice_index(which, node - ivec3(0, 1, 1))].w = value;
}

vec4 lattice_entry(uint i) {
    return TEXELS != 0 ? texelFetch(lattice_texels, int(i)) : lattice[i];
}

// At a point of medium space; beyond the lattice, that of its border.
float lattice_value(uint which, vec3 p) {
    LatticeParams l = frame.lattice;
    vec3 x = clamp((p - l.low) / l.spacing, vec3(0.0), vec3(l.dims - 1));
    ivec3 node = min(ivec3(x), l.dims - 2);
    vec3 f = x - vec3(node);
    uint i = lattice_index(which, node);
    vec4 along_x = mix(lattice_entry(i), lattice_entry(i + uint(l.dims.y * l.dims.z)), f.x);
    vec2 along_y = mix(along_x.xy, along_x.zw, f.y);
    return mix(along_y.x, along_y.y, f.z);
}

#endif
