// Where a ray is inside the medium.
#ifndef INTERVAL_GLSL
#define INTERVAL_GLSL
#include "shapes/mesh.glsl"
#include "shapes/shape.glsl"

// [t.x, t.y], 0 <= t.x < t.y, world distances: the part of the ray within a sphere or a box; false if there is none. A
// mesh has any number of parts, each to be searched for: see mesh.glsl.
bool medium_interval(MediumParams v, Ray ray, out vec2 t) {
    t = vec2(0.0);
    switch (SHAPE) {
    case SHAPE_SPHERE:
        return intersect_unit_ball(ray, t);
    case SHAPE_BOX:
        return intersect_box(ray, v.bounds_min, v.bounds_max, t);
    default:
        return false;
    }
}

// False only if the ray misses the medium.
bool may_meet_medium(MediumParams v, Ray ray) {
    vec2 t;
    return SHAPE == SHAPE_MESH ? may_meet_mesh(v.bvh_nodes, ray) : medium_interval(v, ray, t);
}

#endif
