// Lights at a point: the same in all directions, or in a cone.
#ifndef POINT_GLSL
#define POINT_GLSL
#include "lights/sample.glsl"

LightSample sample_point(LightRow light, vec3 from) {
    vec3 apart = light.position - from;
    float square = dot(apart, apart);
    float distance = sqrt(square);
    vec3 direction = distance > 0.0 ? apart / distance : vec3(0.0, 1.0, 0.0);
    return LightSample(direction, distance, square > 0.0 ? light.radiance / square : vec3(0.0), 0.0);
}

LightSample sample_spot(LightRow light, vec3 from) {
    LightSample drawn = sample_point(light, from);
    float along = -dot(drawn.direction, light.direction);
    // smoothstep is undefined where its edges are equal: a cone without a soft rim
    float t = clamp((along - light.cos_none) / max(light.cos_full - light.cos_none, 1.0e-7), 0.0, 1.0);
    drawn.light *= t * t * (3.0 - 2.0 * t);
    return drawn;
}

#endif
