// What several media send out, or absorb, where a path meets them: each has its part, whichever of them the path goes on with. Left to
// that draw, what a thin one sends out would be found as seldom as it is drawn.
#ifndef STAGE_GLOW_GLSL
#define STAGE_GLOW_GLSL
#include "field/emission.glsl"
#include "lights/glowing.glsl"
#include "stages/lane.glsl"

// The flight's share of it, `flown` behind where the flight began, at `position`.
float share_at(MediumParams met, vec3 position, float flown, Lane lane) {
    float share = 1.0;
    if (SEES_GLOW)
        share = share_of_glow(met, position - flown * lane.path.direction, lane.path.direction, lane.phase_pdf);
    return share;
}

#ifdef SEVERAL
// `per_extinction`: throughput times a length. At p, in the superposition's space, which is `position` in render space, `flown` along
// the flight; their densities are looked up with that `tap`.
void add_glow_of_all(MediumParams v, vec3 per_extinction, vec3 p, vec3 tap, vec3 position, float flown, inout Lane lane) {
    uint k = list_at(v, p);
    for (bool more = k != 0u; more; ++k) {
        uint row = listed(k, more);
        bool glows = media[row].kinds.emission != EMISSION_NONE || media[row].kinds.map == MAP_GLOW;
        float sigma_t = glows ? extinction_of(v, row, v.extent * p, tap) : 0.0;
        if (sigma_t > 0.0) {
            float shared_sigma_t = sigma_t * share_at(media[row], position, flown, lane);
            add_light(lane, per_extinction * shared_sigma_t * media[row].sigma_ratio * emitted_radiance(media[row], position),
                      glow_label(lane.path.depth) | label_at(lane, media[row]));
        }
    }
}

// Likewise of throughput.
vec3 absorbed_by_all(MediumParams v, vec3 per_extinction, vec3 p, vec3 tap, vec3 position) {
    vec3 absorbed = vec3(0.0);
    uint k = list_at(v, p);
    for (bool more = k != 0u; more; ++k) {
        uint row = listed(k, more);
        float sigma_t = extinction_of(v, row, v.extent * p, tap);
        absorbed += per_extinction * sigma_t * media[row].sigma_ratio * absorbed_at(media[row], position);
    }
    return absorbed;
}
#else
void add_glow_of_all(MediumParams v, vec3 per_extinction, vec3 p, vec3 tap, vec3 position, float flown, inout Lane lane) {}
vec3 absorbed_by_all(MediumParams v, vec3 per_extinction, vec3 p, vec3 tap, vec3 position) {
    return vec3(0.0);
}
#endif

#endif
