// The null-collision process along a segment: a walk over the majorant cells that stops at cell faces and at
// tentative collisions. Which tentative collisions are real, and what that means, is the estimators' business.
//
// Distances are world units from where the ray's present part within the medium begins, so their precision is that of
// this part, wherever it lies.
//
// How exact the walk is, with u = 2^-24, for a part from `origin` along `direction` as they stand in single precision:
// * A face has integer coordinates, which are exact. face - origin rounds once (u), the division by the direction's
//   component errs by 2.5 ulp at most (5 u): t_exit is known to 6 u t, and the end of the medium, found by an inverse,
//   to 7 u t. Each is found anew from the origin, so that nothing adds up along the walk; and a common factor of all
//   lengths changes no relative error: scales from 1e-5 to 1e6 are alike, powers of two bit for bit.
// * The point at t, origin + t direction, is off by a product and a sum on top: 7 u t |direction| + u |point|, in
//   voxels. A grid of 1000 voxels knows its points to 5e-4 of a voxel: its density is looked up so far aside.
// * The optical depth left: passing a cell takes away sigma_maj (t_exit - t), whose difference and product round (2 u),
//   and the subtraction rounds to u tau. Errors of t_exit itself cancel between neighbours but for the step of their
//   majorants. After n cells: n u tau_0 + sum of 2 u sigma dt + sum of |sigma - next sigma| 6 u t, where tau_0, the
//   depth drawn, is 16.7 at most and about 1 usually; 1e-5 after a hundred cells, as if extinction were off by that.
// * A collision is at t + tau / sigma_maj: 4 u of the second, and u of the sum.
// * Beyond empty cells crossed together the next cell is that of the point at t, which is off by as much as any point:
//   a cell may be entered that much too early or late.
//
// Why it ends: every step that is no collision changes a coordinate of the cell by one at least, always to the same side,
// and leaves after dims.x + dims.y + dims.z faces at most, also where t stands still because faces coincide. Collisions
// stand still only if the mean free path 1 / sigma_maj is below an ulp of t, that is if some 2^24 of them fit in the
// part: media of optical depth 1e7, whose real collisions end the flight; and beyond any doubt the step limit, which is
// counted.
//
// What comes before the walk: the host composes render -> medium space in double precision about the medium's middle,
// counts voxels from near it, and lets rays begin at the eye only if that is near (SensorParams). So offsets of the
// world's origin, of indices and of the camera are gone before anything is rounded.
#ifndef MAJORANT_GLSL
#define MAJORANT_GLSL
#include "field/grid.glsl"
#include "majorants/cells.glsl"
#include "lib/interval.glsl"

#define EVENT_MOVING 0u  // nothing happened but distance
#define EVENT_COLLIDED 1u
#define EVENT_LEFT 2u    // the end of the part within the medium, or of the whole segment
#define EVENT_TOUCHED 3u // an interaction that leaves the flight as it is: a null collision, a step of a march
#define EVENT_OPAQUE 4u  // nothing of the light is left, no need to go on
#define EVENT_CUT 5u     // by the step limit: its light is lost, and that is counted

// How many cells around the walk's are empty like it, in every direction.
int empty_reach(Walk w) {
    return LEAPS != 0 ? int(max(-w.sigma_maj, 0.0)) : 0;
}

// The cells that the walk passes together: its own, or a coarse one, and those around that are empty like it.
struct CellBlock {
    ivec3 low;
    int edge; // cells
};

CellBlock cells_passed(Walk w) {
    int reach = empty_reach(w);
    CellBlock block = CellBlock(w.cell - reach, 2 * reach + 1);
    if (CELL_BITS != 0)
        block = CellBlock((w.cell & -w.cell_edge) - reach * w.cell_edge, (2 * reach + 1) * w.cell_edge);
    return block;
}

// The last cell, on the way to each side, of a block that has `cell` in it; `cell` itself where there is no such side.
ivec3 last_cell(CellBlock block, ivec3 cell, ivec3 side) {
    ivec3 last = cell + (block.edge >> 1) * side;
    if (CELL_BITS != 0)
        last = mix(mix(block.low, block.low + block.edge - 1, greaterThan(side, ivec3(0))), cell, equal(side, ivec3(0)));
    return last;
}

// What the walk needs of its cell. With `residual` the bound of |density - control|, else that of the density; where that
// is 0, minus the reach of a walk that leaps.
void load_cell(MediumParams v, bool residual, inout Walk w) {
    bool cells = HAS_CELLS;
    uint i = cell_entry(v, w.cell, w.cell_edge);
    w.cell_row = i;
    if (residual || CONTROLLED_FLIGHT)
        w.control = cells ? controls[i].control : v.control;
    if (residual)
        w.sigma_maj = v.sigma_t * (cells ? controls[i].residual : v.residual);
    else {
        float majorant = cells ? cell_majorant(i) : v.majorant;
        w.sigma_maj = (LEAPS == 0 || majorant > 0.0 ? v.sigma_t : 1.0) * majorant;
    }
}

void begin_cells(MediumParams v, bool residual, inout Walk w) {
    w.cell = ivec3(0);
    if (HAS_CELLS)
        w.cell = ivec3(clamp(floor((w.origin - v.cells_min) / v.cell_size), vec3(0.0), vec3(v.cell_dims - 1)));
    load_cell(v, residual, w);
}

// Distances at which the ray crosses the far faces of a cube with lower corner `low`.
vec3 far_faces(Walk w, vec3 low, float size) {
    vec3 face = low + size * vec3(greaterThan(w.direction, vec3(0.0)));
    bvec3 parallel = lessThan(abs(w.direction), vec3(1.0e-30));
    return mix((face - w.origin) / mix(w.direction, vec3(1.0), parallel), vec3(FAR), parallel);
}

// One along the axis whose face is crossed first, 0 along the others.
ivec3 first_axis(vec3 t_face) {
    int axis = t_face.x <= t_face.y && t_face.x <= t_face.z ? 0 : t_face.y <= t_face.z ? 1 : 2;
    return ivec3(equal(ivec3(0, 1, 2), ivec3(axis)));
}

// Where media are everywhere the outermost cells go on for ever: along which axes the walk is on its way there.
bvec3 outward(MediumParams v, Walk w, CellBlock block) {
    bvec3 up = greaterThanEqual(block.low + block.edge, v.cell_dims);
    bvec3 down = lessThanEqual(block.low, ivec3(0));
    return mix(down, up, greaterThan(w.direction, vec3(0.0)));
}

// Where the walk leaves its cell and the empty ones around it, at most t_end.
float cell_exit(MediumParams v, Walk w, out vec3 t_face) {
    t_face = vec3(FAR);
    if (HAS_CELLS) {
        CellBlock block = cells_passed(w);
        t_face = far_faces(w, v.cells_min + v.cell_size * vec3(block.low), v.cell_size * float(block.edge));
        if (UNBOUNDED != 0)
            t_face = mix(t_face, vec3(FAR), outward(v, w, block));
    }
    return max(w.t, min(min(t_face.x, t_face.y), min(t_face.z, w.t_end)));
}

// Into the cell beyond: one step along the axis of the face, and never back along the others. EVENT_LEFT: there is none.
uint next_cell(MediumParams v, bool residual, float t_exit, vec3 t_face, inout Walk w) {
    w.t = t_exit;
    if (!HAS_CELLS)
        return EVENT_LEFT;
    ivec3 side = ivec3(sign(w.direction));
    ivec3 axis = first_axis(t_face);
    ivec3 next = w.cell + axis * side;
    if (LONG_STEPS) {
        ivec3 last = last_cell(cells_passed(w), w.cell, side);
        vec3 point = floor((w.origin - v.cells_min + t_exit * w.direction) * (1.0 / v.cell_size));
        if (UNBOUNDED != 0)
            point = clamp(point, vec3(-1.0), vec3(v.cell_dims)); // integers end sooner
        ivec3 there = ivec3(point);
        ivec3 most = clamp(last, ivec3(0), v.cell_dims - 1);
        next = clamp(there, min(w.cell, most), max(w.cell, most));
        next += axis * (last + side - next);
    }
    ivec3 inside = clamp(next, ivec3(0), v.cell_dims - 1);
    bool left = t_exit >= w.t_end || inside != next;
    w.cell = inside;
    load_cell(v, residual, w);
    return left ? EVENT_LEFT : EVENT_MOVING;
}

// Along the ray, per world unit, of cells like the walk's, which may be a coarse one; of a part without cells, one.
float cells_per_length(MediumParams v, Walk w) {
    vec3 d = abs(w.direction);
    float edge = v.cell_size * (CELL_BITS != 0 ? float(w.cell_edge) : 1.0);
    return HAS_CELLS ? max(d.x, max(d.y, d.z)) / edge : 1.0 / max(w.t_end, 1.0e-30);
}

// One step: to the face of the cell, or to a tentative collision before it (EVENT_COLLIDED).
uint advance(MediumParams v, bool residual, inout Walk w) {
    vec3 t_face;
    float t_exit = cell_exit(v, w, t_face);
    w.rate = LEAPS != 0 ? max(w.sigma_maj, 0.0) : w.sigma_maj;
    if (SPLITS)
        w.rate = w.rate > 0.0 ? max(w.rate, w.least * cells_per_length(v, w)) : 0.0;
    float tau_cell = w.rate * (t_exit - w.t);
    if (w.tau < tau_cell) {
        w.t = min(w.t + w.tau / w.rate, t_exit);
        return EVENT_COLLIDED;
    }
    w.tau = max(w.tau - tau_cell, 0.0); // a driver may have rounded only one of the products
    return next_cell(v, residual, t_exit, t_face, w);
}

#endif
