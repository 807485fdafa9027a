// Where a ray is inside the medium.
#ifndef INTERVAL_GLSL
#define INTERVAL_GLSL
#include "mesh.glsl"
#include "shape.glsl"

// [t.x, t.y], 0 <= t.x < t.y, world distances: the first part of the ray within the medium beyond `from`, which is 0 or
// where the last such part ended; false if there is none. Spheres and boxes have one such part.
bool next_interval(VolumeParams v, Ray ray, float from, out vec2 t) {
    t = vec2(0.0);
    switch (SHAPE) {
    case SHAPE_SPHERE:
        return from == 0.0 && intersect_unit_ball(ray, t);
    case SHAPE_BOX:
        return from == 0.0 && intersect_box(ray, v.bounds_min, v.bounds_max, t);
    case SHAPE_MESH:
        return next_mesh_interval(v.bvh_nodes, ray, from, t);
    default:
        return false;
    }
}

#endif
