// The first flight from the camera, split: what goes through adds the light from beyond, and what collides goes on from one of the
// places where it does. Where a medium is thin, most flights that are drawn go through, and the few that collide bring all that is
// seen of it.
//
// Along the way tentative collisions have the rate mu, at least sigma_maj. Each takes the part sigma_t / mu of the throughput that has
// come so far, and leaves the rest: ratio tracking. One of them is picked in proportion to what they take, by a reservoir (Chao 1982),
// and gets what all of them have taken: its expectation is that of a flight that is drawn, and both sum up to the throughput there was.
// Once little is left a flight that is drawn decides over that: it collides, and competes, or it goes through. So matter that is dense
// costs no more look-ups.
//
// Where sigma_maj is low cells would be left before they have been looked at: mu is so high that each has two tentative collisions, on
// average. It is for nobody to know how thin the medium is on the whole.
#ifndef SPLIT_GLSL
#define SPLIT_GLSL
#include "majorants/collision.glsl"
#include "lib/directions.glsl"

// Measured.
const float LEAST_IN_CELL = HAS_CELLS ? 2.0 : 4.0; // tentative collisions, or without cells in each part
const float DRAWN_BELOW = 0.5;                     // of the throughput
const float HARDLY_SEEN = 0.02;                    // of light that is scattered evenly; chosen, not measured

struct Split {
    SPLIT_STATE(STATE_FIELD)
};

bool splits_here(Walk w, Spectrum beta) {
    return w.least > 0.0 && largest(beta) >= DRAWN_BELOW;
}

// At a tentative collision that takes `part` of the throughput.
uint split_flight(Collision c, Walk w, Spectrum part, inout Spectrum beta, inout Split split) {
    float sum = total(abs(part));
    split.collided += sum;
    if (c.u * split.collided < sum) {
        split.picked = part / sum;
        split.at = w.start + w.t;
        split.met = w.met;
    }
    beta *= 1.0 - c.ratio * (c.sigma_t / c.sigma_maj);
    return EVENT_TOUCHED;
}

// Where the depth of all the way is known, and it is of one colour, nothing tentative is needed. The depth after which what collides
// has collided, if a flight that is drawn would after `drawn`.
float split_depth(float depth, float drawn) {
    return min(minus_log_of_rest(one_minus_exp(drawn) * one_minus_exp(depth)), depth);
}

// Of `beta`, what goes through; what has collided is left in `split`.
void split_at_once(float depth, Walk w, inout Spectrum beta, inout Split split) {
    float sum = total(abs(beta));
    split.collided = sum * one_minus_exp(depth);
    split.picked = beta / max(sum, 1.0e-30);
    split.met = w.met;
    beta *= exp(-depth);
}

// To the collision that was picked.
void go_back(inout Walk w, Split split) {
    w.start = 0.0;
    w.t = split.at;
    w.met = split.met;
}

// What was left has collided, too.
void pick_again(inout Walk w, inout Spectrum beta, out float begun_with, inout Split split, inout Rng rng) {
    float sum = total(abs(beta)), whole = split.collided + sum;
    bool is_earlier = to_event(next_words(rng)) * whole >= sum;
    beta = (is_earlier ? split.picked : beta / sum) * whole;
    if (is_earlier)
        go_back(w, split);
    split.collided = 0.0;
    begun_with = largest(beta);
}

// Of what has collided: it neither glows nor scatters.
bool finds_nothing() {
    const bool glows_there = EMISSION != EMISSION_NONE && EMISSION_AT == EMISSION_AT_COLLISIONS;
    return !glows_there && (SCATTERING == SCATTERING_NONE || frame.max_depth == 0u);
}

// What was left, `through`, has gone through, and meets that `light`. What has collided goes on by chance, with the share, roughly, that
// it has of all there is to be seen, which is that of a drawn flight at least: in front of nothing it mostly does. Whether it does or not, it is first taken to bring the same
// light as what went through, which where it goes on is taken away again: where both are alike, as in an even glow, chance then leaves
// no trace. Hence the throughput that is returned, to be added to the former; its expectation is 0.
// Where it could find nothing it does not go on.
Spectrum stand_in(vec3 light, Spectrum through, out Spectrum beta, inout float begun_with, inout Split split, inout Rng rng) {
    split.collided = finds_nothing() ? 0.0 : split.collided;
    Spectrum whole = split.picked * split.collided;
    float fluence = largest(frame.lights[FRAME_DIRECTIONAL].radiance) + (LIGHTS == LIGHTS_LONE ? 0.0 : frame.fluence);
    float even = max(INV_4PI * fluence + largest(frame.lights[FRAME_BACKGROUND].radiance), 1.0e-20), m = largest(whole);
    float scattered = m * even;
    float share = scattered / max(scattered + largest(light * through) + HARDLY_SEEN * even, 1.0e-30);
    float chance = min(max(m, share), 1.0); // of several colours m may be more
    bool goes_on = to_event(next_words(rng)) < chance;
    beta = over(whole, to_spectrum(vec3(chance)));
    begun_with = largest(beta);
    split.collided = goes_on ? split.collided : 0.0;
    return whole - (goes_on ? beta : to_spectrum(vec3(0.0)));
}

#endif
