// Sensors that read flux: irradiance through a rectangle, fluence at points. They stand among the lights as a collision does, with
// the density of their rays in the place of a phase function: light that no ray meets by chance, of what has no extent or is a
// lamp, they find by a look; what rays meet of the sky, of surfaces and of what glows is shared between the two, by the same weights.
#ifndef FLUX_GLSL
#define FLUX_GLSL
#include "lights/table.glsl"
#include "sensors/camera.glsl"

// Per steradian: of a ray that comes from `direction`.
float flux_pdf(vec3 direction) {
    float pdf = INV_4PI;
    if (SENSOR == SENSOR_IRRADIANCE)
        pdf = max(dot(direction, frame.sensors[0].corner), 0.0) / PI;
    return pdf;
}

LightSample sample_lamp_by_ray(LightRow light, vec3 from, vec3 ray, vec2 u, float select) {
    float share = other_share(SENSOR == SENSOR_IRRADIANCE ? 1.0 / PI : INV_4PI, light, from);
    bool by_ray = select < share;
    vec3 direction = by_ray ? ray : shape_direction(light, from, u);
    float t = by_ray ? hit_lamp(light, from, direction) : shape_distance(light, from, direction);
    return of_mixture(light, from, direction, t, flux_pdf(direction), share);
}

// What a ray from one of all lights would bring on average. The sample's own ray serves where lamps are looked for by rays.
LightSample look_from_sensor(vec3 from, vec3 ray, inout Rng rng, out uint row) {
    uvec4 words = next_words(rng);
    vec2 u = to_uniform(words).zw;
    float chance;
    vec3 normal = SENSOR == SENSOR_IRRADIANCE ? frame.sensors[0].corner : vec3(0.0);
    row = choose_light(lit_point(from, true, normal), words, rng, chance);
    LightRow light = light_at(row);
    LightSample drawn;
    float density = 0.0; // for weights; 0 of what no ray meets
    if (SEES_LAMPS && (light.kind & LIGHT_SHAPED) != 0u)
        drawn = sample_lamp_by_ray(light, from, ray, u, to_tap(words).z);
#ifdef SURFACES
    else if (SEES_SURFACES && light.kind == LIGHT_SURFACE)
        drawn = draw_shining(light, from, u, rng, density);
#endif
    else if (SEES_GLOW && light.kind == LIGHT_GLOW)
        drawn = draw_glow(light, from, u, rng, density);
    else
        drawn = sample_shapeless(light, from, u, rng);
    drawn = over_density(drawn, chance);
    density = max(density, drawn.pdf);
    float by_ray = flux_pdf(drawn.direction);
    float weight = MIS == MIS_LIGHT ? 1.0 : MIS == MIS_PHASE ? 0.0 : mis_weight(density, by_ray);
    drawn.light *= by_ray * (density > 0.0 ? weight : 1.0);
    return drawn;
}

#endif
