// The null-collision process along a segment: a walk over the majorant cells that stops at cell faces and at
// tentative collisions. Which tentative collisions are real, and what that means, is the estimators' business.
//
// Distances are world units from the segment's own start, so their precision is that of the segment, wherever it
// lies. Faces are found from the cell's integer coordinates, never accumulated: no error grows along the walk, and
// every step that leaves a cell changes that integer, so the walk ends after at most dims.x + dims.y + dims.z faces.
#ifndef MAJORANT_GLSL
#define MAJORANT_GLSL
#include "shape.glsl"

struct Walk {
    vec3 origin; // medium space, the segment's start
    vec3 direction;
    float t;     // travelled
    float t_end; // length of the segment
    float tau;   // optical depth left to the next tentative collision
    float sigma_maj; // of the present cell [1 / world unit]; grids only
    ivec3 cell;
};

#define EVENT_MOVING 0u  // nothing happened but distance
#define EVENT_COLLIDED 1u
#define EVENT_LEFT 2u    // the segment's end

float cell_sigma_maj(VolumeParams v, ivec3 cell) {
    return v.sigma_t * majorants[(cell.x * v.cell_dims.y + cell.y) * v.cell_dims.z + cell.z];
}

// The walk along the ray's part [t.x, t.y].
Walk begin_walk(VolumeParams v, Ray ray, vec2 t, float tau) {
    Walk w;
    w.origin = ray.origin + t.x * ray.direction;
    w.direction = ray.direction;
    w.t = 0.0;
    w.t_end = t.y - t.x;
    w.tau = tau;
    w.sigma_maj = 0.0;
    w.cell = ivec3(0);
    if (MEDIUM == MEDIUM_GRID) {
        w.cell = clamp(ivec3(floor((w.origin - v.bounds_min) / v.cell_size)), ivec3(0), v.cell_dims - 1);
        w.sigma_maj = cell_sigma_maj(v, w.cell);
    }
    return w;
}

// One step: to the face of the cell, or to a tentative collision before it (EVENT_COLLIDED).
uint advance(VolumeParams v, inout Walk w) {
    vec3 face = v.bounds_min + v.cell_size * vec3(w.cell + ivec3(greaterThan(w.direction, vec3(0.0))));
    bvec3 parallel = lessThan(abs(w.direction), vec3(1.0e-30));
    vec3 t_face = mix((face - w.origin) / mix(w.direction, vec3(1.0), parallel), vec3(FAR), parallel);
    float t_exit = max(w.t, min(min(t_face.x, t_face.y), min(t_face.z, w.t_end)));
    float tau_cell = w.sigma_maj * (t_exit - w.t);
    if (w.tau < tau_cell) {
        w.t = min(w.t + w.tau / w.sigma_maj, t_exit);
        return EVENT_COLLIDED;
    }
    w.tau -= tau_cell;
    w.t = t_exit;
    int axis = t_face.x <= t_face.y && t_face.x <= t_face.z ? 0 : t_face.y <= t_face.z ? 1 : 2;
    ivec3 step = ivec3(equal(ivec3(0, 1, 2), ivec3(axis)));
    ivec3 next = w.cell + step * ivec3(sign(w.direction));
    ivec3 inside = clamp(next, ivec3(0), v.cell_dims - 1);
    bool left = t_exit >= w.t_end || inside != next;
    w.cell = inside;
    w.sigma_maj = cell_sigma_maj(v, inside);
    return left ? EVENT_LEFT : EVENT_MOVING;
}

#endif
