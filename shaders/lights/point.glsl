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

// `x`: 1 - cos of the angle to its axis.
float spot_falloff(LightRow light, float x) {
    float t = clamp((light.none_beyond - x) / max(light.none_beyond - light.full_within, 1.0e-12), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

LightSample sample_spot(LightRow light, vec3 from) {
    LightSample drawn = sample_point(light, from);
    vec3 apart = drawn.direction + light.direction;
    drawn.light *= spot_falloff(light, 0.5 * dot(apart, apart)); // with all digits where the angle is small
    return drawn;
}

#endif
