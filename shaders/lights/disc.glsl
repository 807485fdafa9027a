// Lights infinitely far away: without extent, or a disc about their direction.
#ifndef DISC_GLSL
#define DISC_GLSL
#include "lights/sample.glsl"

LightSample sample_directional(LightRow light) {
    return LightSample(light.direction, FAR, light.radiance, 0.0);
}

// 1 - cos of the angle from the disc's middle: |a - b|^2 / 2 is 1 - a.b for unit vectors, with all digits where they nearly agree.
float disc_place(LightRow light, vec3 direction) {
    vec3 apart = direction - light.direction;
    return 0.5 * dot(apart, apart);
}

// By the linear law of limb darkening, I = I(1) (1 - u (1 - mu)), mu being the cosine at which light leaves the star. Of a far ball
// that is exactly sqrt(1 - s), s the square of sin(angle) over sin(the rim's): a line of sight at that part of the radius.
vec3 disc_radiance(LightRow light, float place) {
    float s = place * (2.0 - place) / (light.extent * (2.0 - light.extent));
    return light.radiance * (1.0 - light.darkening * (1.0 - sqrt(max(1.0 - s, 0.0))));
}

// Per steradian: the disc's solid angle is 2 pi (1 - cos).
float disc_pdf(LightRow light) {
    return 2.0 * INV_4PI / light.extent;
}

// Evenly: no direction is worth more than twice the mean, however dark the limb.
LightSample sample_disc(LightRow light, vec2 u) {
    float place = light.extent * u.x;
    vec3 direction = turned(light.direction, place, u.y);
    return LightSample(direction, FAR, disc_radiance(light, place), disc_pdf(light));
}

#endif
