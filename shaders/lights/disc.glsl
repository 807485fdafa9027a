// Lights infinitely far away: without extent, or a disc of even radiance about their direction.
#ifndef DISC_GLSL
#define DISC_GLSL
#include "lights/sample.glsl"

LightSample sample_directional(LightRow light) {
    return LightSample(light.direction, FAR, light.radiance, 0.0);
}

// |a - b|^2 / 2 is 1 - a.b for unit vectors, with all digits where they nearly agree.
bool disc_shows(LightRow light, vec3 direction) {
    vec3 apart = direction - light.direction;
    return 0.5 * dot(apart, apart) < light.extent;
}

// Per steradian: the disc's solid angle is 2 pi (1 - cos).
float disc_pdf(LightRow light) {
    return 2.0 * INV_4PI / light.extent;
}

LightSample sample_disc(LightRow light, vec2 u) {
    vec3 direction = turned(light.direction, light.extent * u.x, u.y);
    return LightSample(direction, FAR, light.radiance, disc_pdf(light));
}

#endif
