// Any number of lights of any kind. A look goes toward one of them, chosen with a chance that the host has fixed; what
// flights meet by themselves of a light with extent, they meet when they leave for the sky. Both find the same light, and share the
// work by weights that add up to 1 for every direction: multiple importance sampling (Veach and Guibas, "Optimally Combining
// Sampling Techniques for Monte Carlo Rendering", 1995).
#ifndef LIGHT_TABLE_GLSL
#define LIGHT_TABLE_GLSL
#include "lights/disc.glsl"
#include "lights/point.glsl"
#include "lights/sky.glsl"

// Of a direction that was drawn with density `own`, and that the other technique draws with `other`. Quotients, since the
// densities of small lights overflow when squared.
float mis_weight(float own, float other) {
    float r = other / own;
    return own > 0.0 ? 1.0 / (1.0 + (MIS == MIS_POWER ? r * r : r)) : 0.0;
}
float weight_of_look(float pdf, float phase_pdf) {
    return MIS == MIS_LIGHT || SCATTERING == SCATTERING_SINGLE ? 1.0 : MIS == MIS_PHASE ? 0.0 : mis_weight(pdf, phase_pdf);
}
float weight_of_flight(float phase_pdf, float pdf) {
    return MIS == MIS_PHASE || NEE == NEE_NONE ? 1.0 : MIS == MIS_LIGHT ? 0.0 : mis_weight(phase_pdf, pdf);
}

uint choose_light(uvec4 words) {
    uint i = below(frame.light_count, words.x);
    return choose(lights[i].alias, i, words.y);
}

LightSample sample_light(LightRow light, vec3 from, vec2 u, inout Rng rng) {
    if (LIGHTS == LIGHTS_SKY && light.kind == LIGHT_MAP)
        return sample_sky(u, rng);
    switch (light.kind) {
    case LIGHT_DISC:
        return sample_disc(light, u);
    case LIGHT_POINT:
        return sample_point(light, from);
    case LIGHT_SPOT:
        return sample_spot(light, from);
    default:
        return sample_directional(light);
    }
}

// Light that reaches `from`, over the density with which its direction was drawn: to be multiplied by the phase function,
// whose density of that direction is phase_pdf, and by weight_of_look.
LightSample look_for_light(vec3 from, inout Rng rng) {
    uvec4 words = next_words(rng);
    LightRow light = lights[choose_light(words)];
    LightSample drawn = sample_light(light, from, to_uniform(words).zw, rng);
    drawn.pdf *= light.chance;
    drawn.light /= drawn.pdf > 0.0 ? drawn.pdf : light.chance;
    return drawn;
}

// Radiance that a flight meets when it leaves along `direction`, which the phase function drew with density `phase_pdf`;
// 0 of a camera ray, which sees all there is.
vec3 light_from_beyond(vec3 direction, float phase_pdf) {
    vec3 radiance = vec3(0.0);
    for (uint i = 0u; i < frame.sky_count; ++i) {
        LightRow light = lights[i];
        vec3 shown = vec3(0.0);
        float pdf = light.chance;
        if (light.kind == LIGHT_MAP) {
            vec2 place = sky_place(direction);
            shown = sky_radiance(place);
            pdf *= sky_pdf(place, direction);
        } else if (disc_shows(light, direction)) {
            shown = light.radiance;
            pdf *= disc_pdf(light);
        }
        radiance += shown * (phase_pdf > 0.0 ? weight_of_flight(phase_pdf, pdf) : 1.0);
    }
    return radiance;
}

#endif
