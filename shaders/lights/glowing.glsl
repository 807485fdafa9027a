// Cubes and balls that glow evenly, as lights. Flights meet their glow as they meet any; and looks go to a point of one of them. Of
// these only the direction is drawn as points are, evenly over the volume; how far the look goes is drawn anew, by what may come from
// there, since from within points that are near have no bound. Both find the same light, and share it by weights of directions: a
// look's density but for the chance with which its light was chosen, for which what that is on average stands in, as in shining.glsl.
#ifndef GLOWING_GLSL
#define GLOWING_GLSL
#include "lib/rng.glsl"
#include "lib/spectrum.glsl"
#include "lights/mis.glsl"
#include "lights/sample.glsl"
#include "surfaces/scatterer.glsl"

// Where a ray, in the space in which it is the unit ball or the cube [-1, 1]^3, is within what glows [world units].
bool glow_interval(Ray ray, bool is_ball, out vec2 t) {
    bool hit;
    if (is_ball)
        hit = intersect_unit_ball(ray, t);
    else
        hit = intersect_box(ray, vec3(-1.0), vec3(1.0), t);
    return hit;
}

// The integral of the squared distance along that part of the ray, over its length: by the volume, and times the length, it is the
// density of its direction.
float mean_square(vec2 t) {
    return (t.x * t.x + t.x * t.y + t.y * t.y) / 3.0;
}

// Density, for weights, of looks in a direction that has this part `t` in what glows; 0: there are none. What is so thick that a look
// would have to end within its distance's last digits is but a surface to be seen, which only flights meet rightly.
float glow_density(float look_density, float sigma_t, vec2 t) {
    return sigma_t * t.x < 1.0e5 ? look_density * mean_square(t) * (t.y - t.x) : 0.0;
}

// To that space. A light knows itself where it is: looks from sensors do not know the media.
Ray to_glow(LightRow light, vec3 from, vec3 direction) {
    vec3 u = light.edge_u, v = light.edge_v, w = light.direction, apart = from - light.position;
    vec3 across[3] = vec3[3](cross(v, w), cross(w, u), cross(u, v));
    float volume = dot(u, across[0]);
    return Ray(vec3(dot(across[0], apart), dot(across[1], apart), dot(across[2], apart)) / volume,
               vec3(dot(across[0], direction), dot(across[1], direction), dot(across[2], direction)) / volume);
}

// In its cube or ball; `u` and `w` in [0, 1).
vec3 point_of_glow(LightRow light, vec2 u, float w) {
    vec3 at = 2.0 * vec3(u, w) - 1.0;
    if (light.sides == 0u)
        at = pow(w, 1.0 / 3.0) * in_any_direction(u);
    return light.position + at.x * light.edge_u + at.y * light.edge_v + at.z * light.direction;
}

// How far into a part of this length a look goes: half of all evenly, since there may be other media, and channels that see further, and
// half as the medium itself lets through. `even`: over that density, which is that of even draws times what is returned.
float way_into_glow(float sigma_t, float length_of, vec2 u, out float even) {
    float rate = max(sigma_t, 1.0e-20), most = one_minus_exp(rate * length_of);
    float s = length_of * u.y;
    if (u.x < 0.5)
        s = min(minus_log_of_rest(u.y * most) / rate, length_of);
    even = 0.5 + 0.5 * rate * length_of * exp(-rate * s) / max(most, 1.0e-30);
    return s;
}

// A look's light, over the density that it was drawn with; `density`: that for weights.
LightSample draw_glow(LightRow light, vec3 from, vec2 u, inout Rng rng, out float density) {
    vec4 more = to_uniform(next_words(rng));
    vec3 direction = normalize(point_of_glow(light, u, more.x) - from);
    vec2 t;
    bool hit = glow_interval(to_glow(light, from, direction), light.sides == 0u, t);
    float even;
    float distance = t.x + way_into_glow(light.extent, t.y - t.x, more.yz, even), square = mean_square(t);
    density = hit ? glow_density(light.look_density, light.extent, t) : 0.0;
    hit = density > 0.0;
    return LightSample(direction, distance, hit ? light.radiance * (light.area / (square * even)) : vec3(0.0), 0.0);
}

LightSample sample_glow(Scatterer s, LightRow light, vec3 from, vec3 travel, vec2 u, inout Rng rng) {
    float density;
    LightSample drawn = draw_glow(light, from, u, rng, density);
    drawn.light *= weight_of_look(density, scatter_pdf(s, travel, drawn.direction));
    return drawn;
}

// What is left of a medium's glow to a flight from `from`, whose direction was drawn with density `phase_pdf`: all where that could go
// no other way, as a camera's rays, or where the medium is not looked for.
float share_of_glow(MediumParams m, vec3 from, vec3 direction, float phase_pdf) {
    float share = 1.0;
    if (SEES_GLOW)
        if (phase_pdf > 0.0 && m.look_density > 0.0) {
            vec2 t;
            bool hit = glow_interval(to_medium(m, from, direction), m.kinds.shape == SHAPE_SPHERE, t);
            float density = hit ? glow_density(m.look_density, m.sigma_t, t) : 0.0;
            share = density > 0.0 ? weight_of_flight(phase_pdf, density) : 1.0;
        }
    return share;
}

#endif
