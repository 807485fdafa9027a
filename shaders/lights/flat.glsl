// Rectangles and disks that shine evenly from one side, that of their normal.
#ifndef FLAT_LIGHT_GLSL
#define FLAT_LIGHT_GLSL
#include "lights/sample.glsl"

// Where on it, in halves of its edges or in its radius, from -1 to 1.
bool is_on_flat(LightRow light, vec2 at) {
    return light.kind == LIGHT_DISK ? dot(at, at) < 1.0 : all(lessThan(abs(at), vec2(1.0)));
}

// Square of how far the nearest of it is.
float flat_square(LightRow light, vec3 from) {
    vec3 aside = from - light.position;
    vec2 at = vec2(dot(aside, light.edge_u) / dot(light.edge_u, light.edge_u),
                   dot(aside, light.edge_v) / dot(light.edge_v, light.edge_v));
    at = light.kind == LIGHT_DISK ? at / max(length(at), 1.0) : clamp(at, -1.0, 1.0);
    vec3 apart = aside - at.x * light.edge_u - at.y * light.edge_v;
    return dot(apart, apart);
}

// How far it is to where it shines at a ray; FAR where it does not.
float hit_flat(LightRow light, vec3 from, vec3 direction) {
    float facing = -dot(direction, light.direction);
    float t = facing > 0.0 ? dot(from - light.position, light.direction) / facing : -1.0;
    vec3 aside = from + t * direction - light.position;
    vec2 at = vec2(dot(aside, light.edge_u) / dot(light.edge_u, light.edge_u),
                   dot(aside, light.edge_v) / dot(light.edge_v, light.edge_v));
    return t > 0.0 && is_on_flat(light, at) ? t : FAR;
}

// The same along a direction that was drawn toward it, which rounding may lead past what is small.
float flat_distance(LightRow light, vec3 from, vec3 direction) {
    float facing = -dot(direction, light.direction);
    float t = facing > 0.0 ? dot(from - light.position, light.direction) / facing : -1.0;
    return t > 0.0 ? t : FAR;
}

// Evenly over its area.
vec3 flat_point(LightRow light, vec2 u) {
    vec2 at = light.kind == LIGHT_DISK ? in_disk(u) : 2.0 * u - 1.0;
    return light.position + at.x * light.edge_u + at.y * light.edge_v;
}
vec3 flat_direction(LightRow light, vec3 from, vec2 u) {
    return normalize(flat_point(light, u) - from);
}

// Per steradian, of a direction that meets it at a distance t.
float flat_pdf(LightRow light, vec3 direction, float t) {
    return t * t / (light.area * max(-dot(direction, light.direction), 1.0e-12));
}

#endif
