// Lamps: lights of a shape and place. What passes through them is not stopped, and flights do not meet them: all their light is
// found by looks, and the camera sees them by looks too.
//
// A look's direction is drawn from the lamp's own shape or, with chance c, by the phase function, or as a surface scatters, or a
// sensor of flux draws: one sample of a mixture, weighted
// by the mixture's density. By its shape alone, near a lamp or in a sharp phase function the weight would have no bound.
#ifndef LAMP_GLSL
#define LAMP_GLSL
#include "lights/flat.glsl"
#include "lights/row.glsl"
#include "lights/sphere.glsl"
#include "surfaces/scatterer.glsl"

float hit_lamp(LightRow light, vec3 from, vec3 direction) {
    return light.kind == LIGHT_SPHERE ? hit_sphere(light, from, direction) : hit_flat(light, from, direction);
}

// Nearer than this times what rays begin before a face, along its normal, what is looked for lies in it: by an eighth more than these, as
// in nearest.glsl, and of balls also where they bend away from grazing looks.
float reach_of_face(LightRow light) {
    return light.kind == LIGHT_SPHERE ? 2.0 : 1.125;
}

// Density of the shape's own directions, per steradian.
float lamp_pdf(LightRow light, vec3 from, vec3 direction, float t) {
    return light.kind == LIGHT_SPHERE ? sphere_pdf(light, from) : flat_pdf(light, direction, t);
}

// c: next to nothing for what is small as seen from here, against the narrowest that the phase function draws toward it; most for what is
// large, but never all. What 0.85 is worth: tools/results/README.md. Of what is flat it is the nearest of it that counts, which may
// be long; of a ball directions are even anyway.
float share_of(float filled, float square) {
    float share = 0.85 * filled / (filled + square);
    return MIS == MIS_LIGHT ? 0.0 : MIS == MIS_PHASE ? 1.0 : share;
}
float other_share(float peak, LightRow light, vec3 from) {
    vec3 apart = light.position - from;
    float square = light.kind == LIGHT_SPHERE ? dot(apart, apart) : flat_square(light, from);
    return share_of(peak * light.area, max(square, 1.0e-30));
}

vec3 shape_direction(LightRow light, vec3 from, vec2 u) {
    return light.kind == LIGHT_SPHERE ? sphere_direction(light, from, u) : flat_direction(light, from, u);
}
// Along a direction that was drawn so.
float shape_distance(LightRow light, vec3 from, vec3 direction) {
    return light.kind == LIGHT_SPHERE ? sphere_distance(light, from, direction) : flat_distance(light, from, direction);
}

// `other`: density of the direction by what is not the shape. `pdf` of what is returned: 0, for no flight meets it. Its light is
// over the mixture's density already.
LightSample of_mixture(LightRow light, vec3 from, vec3 direction, float t, float other, float share) {
    float density = mix(lamp_pdf(light, from, direction, t), other, share);
    bool seen = t < FAR && density > 0.0;
    return LightSample(direction, t, seen ? light.radiance / density : vec3(0.0), 0.0);
}

LightSample sample_lamp(Scatterer s, LightRow light, vec3 from, vec3 travel, vec2 u, float select) {
    vec3 apart = light.position - from;
    float distance = max(length(apart), 1.0e-30);
    float sine = (light.kind == LIGHT_SPHERE ? light.extent : length(light.edge_u + light.edge_v)) / distance;
    float share = other_share(scatter_peak(s, travel, apart / distance, sine), light, from);
    bool by_phase = select < share;
    vec3 direction;
    if (by_phase)
        direction = scatter_direction(s, travel, u);
    else
        direction = shape_direction(light, from, u);
    float t = by_phase ? hit_lamp(light, from, direction) : shape_distance(light, from, direction);
    return of_mixture(light, from, direction, t, scatter_pdf(s, travel, direction), share);
}

// The nearest of those that have bodies, which hides all lamps behind it; a row that is none if the ray meets none.
uint nearest_body(vec3 from, vec3 direction, out float nearest) {
    uint row = NO_LIGHT;
    nearest = FAR;
    if (HAS_SURFACES)
        for (uint i = frame.lamp_first; i < frame.lamp_first + frame.lamp_count; ++i) {
            float t = light_at(i).body != NO_SURFACE ? hit_lamp(light_at(i), from, direction) : FAR;
            row = t < nearest ? i : row;
            nearest = min(nearest, t);
        }
    return row;
}

// What the camera sees along a ray: one of the lamps that it meets, and its row. By u in [0, 1), half of the time as each of them
// is bright, and half all alike: nobody knows yet what is in the way of which.
LightSample seen_lamp(vec3 from, vec3 direction, float u, out uint row) {
    LightSample seen = LightSample(direction, FAR, vec3(0.0), 0.0);
    bool alike = u < 0.5;
    u = alike ? 2.0 * u : 2.0 * u - 1.0;
    float met = 0.0, sum = 0.0, own = 0.0, weights = 0.0; // how many, their radiances over all channels, and of the one at hand
    row = frame.lamp_first;
    float hidden;
    uint front = nearest_body(from, direction, hidden);
    for (uint i = frame.lamp_first; i < frame.lamp_first + frame.lamp_count; ++i) {
        float t = hit_lamp(light_at(i), from, direction);
        float bright = dot(light_at(i).radiance, vec3(1.0));
        if ((t < hidden || i == front) && bright > 0.0) {
            // With chance weight / weights the latest takes the place of the one before: u is stretched to what is left of it.
            float weight = alike ? 1.0 : bright, before = weights;
            weights += weight;
            bool taken = u * weights < weight || before == 0.0;
            u = min(taken ? u * weights / weight : (u * weights - weight) / max(before, 1.0e-30), 0.99999994);
            met += 1.0;
            sum += bright;
            seen.distance = taken ? t : seen.distance;
            seen.light = taken ? light_at(i).radiance : seen.light;
            own = taken ? bright : own;
            row = taken ? i : row;
        }
    }
    seen.light *= met > 0.0 ? 2.0 / (1.0 / met + own / sum) : 0.0;
    return seen;
}

#endif
