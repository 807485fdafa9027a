// Walking a grid voxel by voxel, exactly. Between voxel centres the trilinear density along a ray is a cubic in t, so
// four values per voxel cell tell its integral; with nearest lookup it is constant. Majorant cells without density are
// crossed in one step each.
#ifndef VOXELS_GLSL
#define VOXELS_GLSL
#include "field/density.glsl"
#include "majorants/majorant.glsl"
#include "lib/tally.glsl"

// With nearest lookup the cell of constant density around a voxel begins half a voxel below its centre.
float voxel_shift() {
    return FILTER == FILTER_NEAREST ? 0.5 : 0.0;
}

// With trilinear lookup the last cell begins at the last voxel.
ivec3 last_voxel(MediumParams v) {
    return v.density.voxel_max + (FILTER == FILTER_NEAREST ? 1 : 0);
}

// Rounding may put where the medium begins a little before its box.
void begin_voxels(MediumParams v, inout Walk w) {
    w.cell = clamp(ivec3(floor(w.origin + voxel_shift())), v.density.voxel_min - 1, last_voxel(v));
}

// Density along the piece as a polynomial in s in [0, 1].
vec4 voxel_polynomial(MediumParams v, Walk w, float t_exit) {
    if (FILTER == FILTER_NEAREST)
        return vec4(mapped(v, voxel(v.density, GRID_TYPE, w.cell)), 0.0, 0.0, 0.0);
    float corner[8];
    [[unroll]] for (int i = 0; i < 8; ++i)
        corner[i] = voxel(v.density, GRID_TYPE, w.cell + ivec3(i >> 2, i >> 1 & 1, i & 1));
    float f[4];
    [[unroll]] for (int i = 0; i < 4; ++i) {
        float t = mix(w.t, t_exit, float(i) / 3.0);
        vec3 p = clamp(w.origin + t * w.direction - vec3(w.cell), vec3(0.0), vec3(1.0));
        vec4 edges = mix(vec4(corner[0], corner[2], corner[4], corner[6]),
                         vec4(corner[1], corner[3], corner[5], corner[7]), p.z);
        vec2 sides = mix(edges.xz, edges.yw, p.y);
        f[i] = mix(sides.x, sides.y, p.x);
    }
    // Through the values at s = 0, 1/3, 2/3, 1.
    return vec4(f[0], -5.5 * f[0] + 9.0 * f[1] - 4.5 * f[2] + f[3],
                9.0 * f[0] - 22.5 * f[1] + 18.0 * f[2] - 4.5 * f[3],
                -4.5 * f[0] + 13.5 * f[1] - 13.5 * f[2] + 4.5 * f[3]);
}

// Integral of the polynomial from 0 to s.
float integral(vec4 c, float s) {
    return s * (c.x + s * (c.y * 0.5 + s * (c.z * (1.0 / 3.0) + s * c.w * 0.25)));
}

// Where that integral, which rises, reaches `target`: bisection to 2^-22 of a voxel.
float solve_integral(vec4 c, float target) {
    float low = 0.0;
    float width = 1.0;
    [[unroll]] for (int i = 0; i < 22; ++i) {
        width *= 0.5;
        low += integral(c, low + width) < target ? width : 0.0;
    }
    return low + 0.5 * width;
}

// The voxel at hand, or the whole majorant cell around it where that is empty.
struct Block {
    ivec3 low;
    int size; // voxels
    bool empty;
};

Block block_of(MediumParams v, Walk w) {
    ivec3 origin = v.density.voxel_min - 1;
    int size = max(int(v.cell_size), 1); // 0, as the number of cells, where there is no medium
    ivec3 cell = clamp((w.cell - origin) / size, ivec3(0), max(v.cell_dims - 1, 0));
    uint entry = uint((cell.x * v.cell_dims.y + cell.y) * v.cell_dims.z + cell.z);
    bool empty = SHAPE == SHAPE_NONE ? true : FILTER != FILTER_NEAREST && cell_majorant(entry) <= 0.0;
    return empty ? Block(origin + cell * size, size, true) : Block(w.cell, 1, false);
}

// From [w.t, t_exit] into the next voxel.
uint next_voxel(MediumParams v, Block block, float t_exit, vec3 t_face, inout Walk w) {
    w.t = t_exit;
    ivec3 axis = first_axis(t_face);
    ivec3 inside = clamp(ivec3(floor(w.origin + t_exit * w.direction + voxel_shift())), block.low,
                         block.low + block.size - 1);
    ivec3 beyond = mix(block.low - 1, block.low + block.size, greaterThan(w.direction, vec3(0.0)));
    w.cell = inside + axis * (beyond - inside);
    // Rounding may put the last face a little before t_end.
    bool beyond_all = w.cell != clamp(w.cell, v.density.voxel_min - 1, last_voxel(v));
    return t_exit >= w.t_end || beyond_all ? EVENT_LEFT : EVENT_MOVING;
}

// One step, adding what the voxel holds to w.depth. EVENT_COLLIDED: the optical depth w.tau was reached in it.
uint voxel_step(MediumParams v, bool seeing, inout Walk w, inout Tally tally) {
    Block block = block_of(v, w);
    vec3 t_face = far_faces(w, vec3(block.low) - voxel_shift(), float(block.size));
    float t_exit = max(w.t, min(min(t_face.x, t_face.y), min(t_face.z, w.t_end)));
    vec4 polynomial = vec4(0.0);
    if (!block.empty) {
        polynomial = voxel_polynomial(v, w, t_exit);
        tally.lookups += 1u;
    }
    float length = t_exit - w.t;
    float depth = max(length * integral(polynomial, 1.0), 0.0);
    tally.cells += 1u;
    if (!seeing && w.tau < v.sigma_t * depth) {
        float rest = w.tau / v.sigma_t;
        w.t += length * solve_integral(polynomial, rest / length);
        w.at = w.t;
        w.depth += rest;
        return EVENT_COLLIDED;
    }
    w.tau = max(w.tau - (seeing ? 0.0 : v.sigma_t * depth), 0.0); // as in majorant.glsl
    w.depth += depth;
    return next_voxel(v, block, t_exit, t_face, w);
}

#endif
