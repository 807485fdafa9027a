// Balls that shine outwards, evenly.
#ifndef SPHERE_LIGHT_GLSL
#define SPHERE_LIGHT_GLSL
#include "lights/sample.glsl"

// 1 - cos of the angle from the middle to the rim as seen from outside: with s the square of radius over distance,
// 1 - sqrt(1 - s), without cancellation. 0 from within, where nothing of it shines.
float sphere_rim(LightRow light, vec3 from) {
    vec3 apart = light.position - from;
    float s = light.extent * light.extent / max(dot(apart, apart), 1.0e-30);
    return s < 1.0 ? s / (1.0 + sqrt(1.0 - s)) : 0.0;
}

// How far it is to where the ball shines at a ray; FAR where it does not.
float hit_sphere(LightRow light, vec3 from, vec3 direction) {
    vec3 apart = light.position - from;
    float middle = dot(apart, direction);
    vec3 miss = apart - middle * direction;
    float inside = light.extent * light.extent - dot(miss, miss);
    // The nearer of two, whose product is the square of the distance to the middle less the radius's: positive from outside,
    // however near the ball is.
    float far = length(apart);
    float t = (far - light.extent) * (far + light.extent) / (middle + sqrt(max(inside, 0.0)));
    return inside > 0.0 && middle > 0.0 && t > 0.0 ? t : FAR;
}

// The same along a direction that was drawn toward it, which rounding may lead past what is small.
float sphere_distance(LightRow light, vec3 from, vec3 direction) {
    vec3 apart = light.position - from;
    float t = hit_sphere(light, from, direction);
    return t < FAR || sphere_rim(light, from) == 0.0 ? t : max(dot(apart, direction), 0.0);
}

// Evenly over the solid angle that it takes.
vec3 sphere_direction(LightRow light, vec3 from, vec2 u) {
    return turned(normalize(light.position - from), sphere_rim(light, from) * u.x, u.y);
}

float sphere_pdf(LightRow light, vec3 from) {
    float rim = sphere_rim(light, from);
    return rim > 0.0 ? 2.0 * INV_4PI / rim : 0.0;
}

#endif
