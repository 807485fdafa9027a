// Where a ray is inside the medium, in medium space.
#ifndef SHAPE_GLSL
#define SHAPE_GLSL
#include "lib/buffers.glsl"

const float FAR = 3.0e38;

// Spare distance by a place's largest coordinate, world units: more than places on surfaces err by, see mesh.glsl.
float spare_at(vec3 place) {
    vec3 reach = abs(place);
    return SURFACE_SPARE * max(reach.x, max(reach.y, reach.z));
}

// A ray in medium space; `direction` is what one world unit of travel becomes there, so t is a world distance.
struct Ray {
    vec3 origin;
    vec3 direction;
};

Ray to_medium(MediumParams v, vec3 position, vec3 direction) {
    vec4 p = vec4(position, 1.0);
    return Ray(vec3(dot(v.to_medium[0], p), dot(v.to_medium[1], p), dot(v.to_medium[2], p)),
               vec3(dot(v.to_medium[0].xyz, direction), dot(v.to_medium[1].xyz, direction),
                    dot(v.to_medium[2].xyz, direction)));
}

// Entry and exit of the slab test. A direction component of 0 leaves that axis without limit, or misses; a component
// so small that its inverse overflows is taken for 0, so that no 0 * infinity arises.
bool intersect_box(Ray ray, vec3 low, vec3 high, out vec2 t) {
    t = vec2(0.0, FAR);
    bool hit = true;
    [[unroll]] for (int axis = 0; axis < 3; ++axis) {
        float d = ray.direction[axis];
        float o = ray.origin[axis];
        bool parallel = abs(d) < 1.0e-30;
        float inverse = 1.0 / (parallel ? 1.0 : d);
        float a = (low[axis] - o) * inverse;
        float b = (high[axis] - o) * inverse;
        t.x = parallel ? t.x : max(t.x, min(a, b));
        t.y = parallel ? t.y : min(t.y, max(a, b));
        hit = hit && (!parallel || (o >= low[axis] && o <= high[axis]));
    }
    return hit && t.x < t.y;
}

// The unit ball. The discriminant is formed at the point of closest approach, where nothing large cancels.
bool intersect_unit_ball(Ray ray, out vec2 t) {
    float dd = dot(ray.direction, ray.direction);
    float middle = -dot(ray.origin, ray.direction) / dd;
    vec3 closest = ray.origin + middle * ray.direction;
    float inside = 1.0 - dot(closest, closest);
    float half_chord = sqrt(max(inside, 0.0) / dd);
    t = vec2(max(middle - half_chord, 0.0), middle + half_chord);
    return inside > 0.0 && t.x < t.y;
}

#endif
