// Free flights: where along the segment the next real collision is. One file per estimator, one switch.
#ifndef FREE_FLIGHT_GLSL
#define FREE_FLIGHT_GLSL
#include "majorants/collision.glsl"
#include "estimators/march.glsl"
#include "estimators/split.glsl"
#include "field/voxels.glsl"

#include "estimators/flight/adaptive_flight.glsl"
#include "estimators/flight/analytic_flight.glsl"
#include "estimators/flight/decomposition_flight.glsl"
#include "estimators/flight/delta_flight.glsl"
#include "estimators/flight/march_flight.glsl"
#include "estimators/flight/regular_flight.glsl"
#include "estimators/flight/spectral_flight.glsl"
#include "estimators/flight/weighted_flight.glsl"

// The optical depth to fly. `e`: unit exponential; `select` in [0, 1).
float begin_flight(MediumParams v, Spectrum beta, float e, float select) {
    return NULL_FLIGHT ? e : sample_depth(v, beta, e, select);
}

// Called for each part of the ray within the medium.
void begin_flight_part(MediumParams v, inout Walk w) {
    if ((FLIGHT_TRAITS & TRAIT_CELLS) != 0)
        begin_cells(v, false, w);
    if ((FLIGHT_TRAITS & TRAIT_VOXELS) != 0)
        begin_voxels(v, w);
    if ((FLIGHT_TRAITS & TRAIT_EQUAL_STEPS) != 0)
        begin_march(frame.march.step, w);
}

// One step of a flight. For flights with null collisions `event` is what the walk met, and `c` its tentative collision.
// `deposit`: at EVENT_TOUCHED and EVENT_COLLIDED, how much throughput meets matter at w.at: beta sigma_t / sigma_maj, or
// what a march's step takes away.
uint fly(MediumParams v, Collision c, uint event, inout Walk w, inout Rng rng, inout Spectrum beta,
         inout Split split, out Spectrum deposit, inout Tally tally) {
    deposit = to_spectrum(vec3(0.0));
    if (NULL_FLIGHT && event == EVENT_COLLIDED) {
        float share = CONTROLLED_FLIGHT ? decomposition_share(c) : c.sigma_t / c.sigma_maj;
        deposit = beta * c.ratio * share * c.share;
        if (SPLITS && splits_here(w, beta)) {
            event = split_flight(c, w, deposit, beta, split);
        } else {
            switch (FREE_FLIGHT) {
            case FREE_FLIGHT_DELTA:
                event = delta_flight(c);
                break;
            case FREE_FLIGHT_WEIGHTED:
                event = weighted_flight(c, beta);
                break;
            case FREE_FLIGHT_DECOMPOSITION:
                event = decomposition_flight(c);
                break;
            case FREE_FLIGHT_SPECTRAL:
                event = spectral_flight(c, beta);
                break;
            }
        }
        tally.null_collisions += event == EVENT_TOUCHED ? 1u : 0u;
    }
    switch (FREE_FLIGHT) {
    case FREE_FLIGHT_ANALYTIC:
        event = analytic_flight(v, w, beta, split, deposit);
        break;
    case FREE_FLIGHT_REGULAR:
        event = regular_flight(v, w, tally);
        break;
    case FREE_FLIGHT_MARCH:
        event = march_flight(v, w, rng, beta, deposit, tally);
        break;
    case FREE_FLIGHT_ADAPTIVE:
        event = adaptive_flight(v, w, rng, beta, deposit, tally);
        break;
    }
    if (!goes_through() && NEE != NEE_TENTATIVE && event == EVENT_TOUCHED)
        event = EVENT_MOVING; // nobody asks
    if (event == EVENT_COLLIDED) {
        tally.real_collisions += 1u;
        if (NULL_FLIGHT) {
            w.per_extinction = vec3(over(beta, c.sigma_t * c.ratio));
            beta *= c.share;
        } else {
            beta *= depth_weight(v, beta, w.depth, true);
        }
    }
    return event;
}

#endif
