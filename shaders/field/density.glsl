// Grid values at points of index space, read from the NanoVDB buffers themselves.
//
// Leaves are found through a dense table, one word per aligned 8^3 block between the grid's bounds: the word offset
// of the leaf node times two, plus one; or, where the tree has a tile or its background, the word offset of that
// value times two. Walking the tree for each of eight corners costs three times as much.
#ifndef DENSITY_GLSL
#define DENSITY_GLSL
#include "field/grid.glsl"
#include "field/noise.glsl"
#include "field/layers.glsl"

// Word offsets within a leaf node of NanoVDB 32.x.
const uint LEAF_FLAGS = 3u;    // quantised: bits 29-31 are log2 of the bits per value
const uint LEAF_MINIMUM = 20u; // quantised: value of code 0
const uint LEAF_QUANTUM = 21u; // quantised: value step per code
const uint LEAF_VALUES = 24u;
const uint LEAF_COLORS = 32u; // of GRID_COLOR

float leaf_value(int type, uint leaf, uint n) {
    uint log2_bits = type == GRID_FP4    ? 2u
                     : type == GRID_FP8  ? 3u
                     : type == GRID_FP16 ? 4u
                                         : grid_word(leaf + LEAF_FLAGS) >> 29u;
    uint word = grid_word(leaf + LEAF_VALUES + (n >> (5u - log2_bits)));
    uint shift = (n & ((32u >> log2_bits) - 1u)) << log2_bits;
    uint code = (word >> shift) & ((1u << (1u << log2_bits)) - 1u);
    float minimum = uintBitsToFloat(grid_word(leaf + LEAF_MINIMUM));
    float quantum = uintBitsToFloat(grid_word(leaf + LEAF_QUANTUM));
    return max(float(code) * quantum + minimum, 0.0);
}

// Where a voxel's value is: in two reads, of the leaf table and of the grid. Apart, so that those of several voxels can be
// under way at once.
struct VoxelPlace {
    uint entry;  // of the leaf table
    uint n;      // in the leaf
    bool inside; // the box of active voxels
};

VoxelPlace find_voxel(GridParams g, ivec3 ijk) {
    ivec3 inside = clamp(ijk, g.voxel_min, g.voxel_max);
    ivec3 block = (inside >> 3) - g.leaf_min;
    ivec3 low = inside & 7;
    return VoxelPlace(g.first_entry + uint((block.x * g.leaf_dims.y + block.y) * g.leaf_dims.z + block.z),
                      uint(low.x << 6 | low.y << 3 | low.z), inside == ijk);
}

// `entry`: what the leaf table says. No branch: lanes disagree at every edge anyway.
float voxel_value(GridParams g, int type, VoxelPlace place, uint entry) {
    bool in_leaf = (entry & 1u) != 0u;
    uint at = g.first_word + (entry >> 1u);
    float value;
    if (type == GRID_FLOAT)
        value = uintBitsToFloat(grid_word(at + (in_leaf ? LEAF_VALUES + place.n : 0u)));
    else
        value = in_leaf ? leaf_value(type, at, place.n) : uintBitsToFloat(grid_word(at));
    return place.inside ? value : 0.0;
}

// Value of voxel `ijk`, >= 0; 0 outside the box of active voxels. `type` is a specialization constant, or, of several grids, of a row.
float voxel(GridParams g, int type, ivec3 ijk) {
    VoxelPlace place = find_voxel(g, ijk);
    return voxel_value(g, type, place, leaf_entry(place.entry));
}

ivec3 nearest_voxel(vec3 p) {
    return ivec3(floor(p + 0.5));
}

float lookup_trilinear(GridParams g, int type, vec3 p) {
    vec3 base = floor(p);
    vec3 f = p - base;
    ivec3 i = ivec3(base);
    float plane[2];
    [[unroll]] for (int x = 0; x < 2; ++x) {
        float low = mix(voxel(g, type, i + ivec3(x, 0, 0)), voxel(g, type, i + ivec3(x, 0, 1)), f.z);
        float high = mix(voxel(g, type, i + ivec3(x, 1, 0)), voxel(g, type, i + ivec3(x, 1, 1)), f.z);
        plane[x] = mix(low, high, f.y);
    }
    return mix(plane[0], plane[1], f.x);
}

// Of what no estimator knows to be linear: as densities are, but never by a corner that is drawn.
float lookup_value(GridParams g, int type, vec3 p) {
    return FILTER == FILTER_NEAREST ? voxel(g, type, nearest_voxel(p)) : lookup_trilinear(g, type, p);
}

vec3 voxel_color(GridParams g, ivec3 ijk) {
    VoxelPlace place = find_voxel(g, ijk);
    uint entry = leaf_entry(place.entry);
    uint at = g.first_word + (entry >> 1u) + ((entry & 1u) != 0u ? LEAF_COLORS + 3u * place.n : 0u);
    vec3 color = uintBitsToFloat(uvec3(grid_word(at), grid_word(at + 1u), grid_word(at + 2u)));
    return place.inside ? color : vec3(0.0);
}

// Colour of a grid of colours; grey if the grid is of numbers.
vec3 lookup_color(GridParams g, int type, vec3 p) {
    vec3 result = vec3(0.0);
    if (type == GRID_COLOR && FILTER == FILTER_NEAREST) {
        result = voxel_color(g, nearest_voxel(p));
    } else if (type == GRID_COLOR) {
        vec3 base = floor(p);
        vec3 f = p - base;
        [[unroll]] for (int i = 0; i < 8; ++i) {
            ivec3 corner = ivec3(i >> 2, i >> 1 & 1, i & 1);
            vec3 weights = mix(1.0 - f, f, vec3(corner));
            result += weights.x * weights.y * weights.z * voxel_color(g, ivec3(base) + corner);
        }
    } else {
        result = vec3(lookup_value(g, type, p));
    }
    return result;
}

// One corner, chosen with its trilinear weight (Pharr et al., "Filtering After Shading", 2024): the expectation is
// the trilinear value, so it may stand wherever the value enters linearly.
ivec3 random_corner(vec3 p, vec3 tap) {
    vec3 base = floor(p);
    return ivec3(base) + ivec3(lessThan(tap, p - base));
}

float lookup(GridParams g, int type, vec3 p, vec3 tap) {
    switch (FILTER) {
    case FILTER_NEAREST:
        return voxel(g, type, nearest_voxel(p));
    case FILTER_STOCHASTIC:
        return voxel(g, type, random_corner(p, tap));
    default:
        return lookup_trilinear(g, type, p);
    }
}

#ifndef SEVERAL
// At a point of medium space, >= 0. `tap` in [0, 1)^3 is for the stochastic filter.
float density(MediumParams v, vec3 p, vec3 tap) {
    if (FIELD == FIELD_CONSTANT)
        return 1.0;
    if (FIELD == FIELD_NOISE)
        return noise_density(v.noise, 0u, v.extent * p);
    if (LAYERED)
        return layered_density(MAP, v, p);
    return mapped(v, lookup(v.density, GRID_TYPE, p, tap));
}
#endif

#endif
