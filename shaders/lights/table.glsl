// Any number of lights of any kind. A look goes toward one of them, chosen with a chance that the host has fixed; what
// flights meet by themselves of a light with extent, they meet when they leave for the sky, or come to a surface that shines, or a medium
// that glows.
#ifndef LIGHT_TABLE_GLSL
#define LIGHT_TABLE_GLSL
#include "lights/disc.glsl"
#include "lights/glowing.glsl"
#include "lights/lamp.glsl"
#include "lights/mis.glsl"
#include "lights/point.glsl"
#include "lights/shining.glsl"
#include "lights/sky.glsl"
#include "lights/tree.glsl"

bool is_map(LightRow light) {
    return HAS_SKY_MAP && (SOLE_LIGHT || light.kind == LIGHT_MAP);
}

// The row of a light, and the chance with which it was chosen.
uint choose_light(Lit lit, uvec4 words, inout Rng rng, out float chance) {
    uint i = 0u;
    chance = 1.0;
    if (!SOLE_LIGHT) {
        i = below(frame.choices, words.x);
        i = choose(light_at(i).alias, i, words.y);
        chance = light_at(i).chance;
    }
    if (HAS_TREE && i == frame.choices - 1u) {
        float of_leaf;
        i = descend(lit, rng, of_leaf);
        chance *= of_leaf;
    }
    return i;
}

// A look toward a light that is no lamp.
LightSample sample_shapeless(LightRow light, vec3 from, vec2 u, inout Rng rng) {
    LightSample drawn;
    if (is_map(light))
        drawn = sample_sky(u, rng);
    else if (light.kind == LIGHT_SUN)
        drawn = sample_disc(light, u);
    else if (light.kind == LIGHT_POINT)
        drawn = sample_point(light, from);
    else if (light.kind == LIGHT_SPOT)
        drawn = sample_spot(light, from);
    else
        drawn = sample_directional(light);
    return drawn;
}

// Per steradian, with which directions of what lies beyond all matter are drawn, and the radiance that comes from there.
SkyValue beyond_toward(LightRow light, vec3 direction) {
    SkyValue value;
    if (is_map(light)) {
        value = sky_toward(direction, sky_place(direction));
    } else {
        float place = disc_place(light, direction);
        value = SkyValue(place < light.extent ? disc_radiance(light, place) : vec3(0.0), place < light.extent ? disc_pdf(light) : 0.0);
    }
    return value;
}

// Where light is scattered once, no flight meets what lies beyond: a look's direction is drawn from it or as `s` scatters, as with lamps.
// Draws by `s` that miss a sun are lost, and those from it suffice until some of it has several times what is drawn evenly. Of a map
// nobody knows how large it is to `s`: half the looks at most, and most of these where some directions have fifty times an even share.
LightSample look_beyond(Scatterer s, LightRow light, vec3 travel, vec2 u, float select, LightSample drawn) {
    bool everywhere = is_map(light) || light.extent >= 1.0;
    float sine = everywhere ? 1.0 : sqrt(light.extent * (2.0 - light.extent));
    float peak = scatter_peak(s, travel, light.direction, sine) / INV_4PI;
    float share = is_map(light) ? share_of(peak, 50.0) : share_of(0.5 * light.extent * peak, 4.0);
    share = is_map(light) && MIS != MIS_PHASE ? min(share, 0.5) : share;
    if (select < share) {
        drawn.direction = scatter_direction(s, travel, u);
        SkyValue there = beyond_toward(light, drawn.direction);
        drawn.light = there.radiance;
        drawn.pdf = there.pdf;
    }
    drawn.pdf = mix(drawn.pdf, scatter_pdf(s, travel, drawn.direction), share);
    drawn.light *= drawn.pdf > 0.0 ? 1.0 : 0.0;
    return drawn;
}

LightSample sample_light(Scatterer s, LightRow light, vec3 from, vec3 travel, uvec4 words, inout Rng rng) {
    vec2 u = to_uniform(words).zw;
    LightSample drawn;
    if (SEES_LAMPS && (light.kind & LIGHT_SHAPED) != 0u)
        drawn = sample_lamp(s, light, from, travel, u, to_tap(words).z);
#ifdef SURFACES
    else if (SEES_SURFACES && light.kind == LIGHT_SURFACE)
        drawn = sample_shining(s, light, from, travel, u, rng);
#endif
    else if (SEES_GLOW && light.kind == LIGHT_GLOW)
        drawn = sample_glow(s, light, from, travel, u, rng);
    else
        drawn = sample_shapeless(light, from, u, rng);
    if (SEES_SKY && SCATTERING == SCATTERING_SINGLE && MIS != MIS_LIGHT)
        if (is_map(light) || light.kind == LIGHT_SUN)
            drawn = look_beyond(s, light, travel, u, to_tap(words).z, drawn);
    return drawn;
}

// Over the density with which its direction was drawn, where its light was chosen with `chance`.
LightSample over_density(LightSample drawn, float chance) {
    drawn.pdf *= chance;
    drawn.light /= drawn.pdf > 0.0 ? drawn.pdf : chance;
    return drawn;
}

// Light that reaches `from`, over the density with which its direction was drawn: to be multiplied by scatter_value, and by
// weight_of_look with scatter_pdf. `travel`: how the path came there.
LightSample look_for_light(Scatterer s, vec3 from, vec3 travel, inout Rng rng, out LightRow light) {
    uvec4 words = next_words(rng);
    float chance;
    light = light_at(choose_light(lit_point(from, is_surface(s), lit_side(s)), words, rng, chance));
    return over_density(sample_light(s, light, from, travel, words, rng), chance);
}

// Per steradian, with which such a light's direction is drawn.
float pdf_from_beyond(LightRow light, vec3 direction) {
    float pdf;
    if (is_map(light))
        pdf = sky_toward(direction, sky_place(direction)).pdf;
    else
        pdf = disc_pdf(light);
    return pdf;
}

// Radiance that a flight meets of one light when it leaves along `direction`, which the phase function drew with density
// `phase_pdf`; 0 of a camera ray, which sees all there is.
vec3 light_from_one(LightRow light, vec3 direction, float phase_pdf) {
    SkyValue value = beyond_toward(light, direction);
    float pdf = value.pdf * (SOLE_LIGHT ? 1.0 : light.chance);
    return value.radiance * (phase_pdf > 0.0 ? weight_of_flight(phase_pdf, pdf) : 1.0);
}

vec3 light_from_beyond(vec3 direction, float phase_pdf) {
    vec3 radiance = vec3(0.0);
    for (uint i = 0u; i < frame.sky_count; ++i)
        radiance += light_from_one(light_at(i), direction, phase_pdf);
    return radiance;
}

#endif
