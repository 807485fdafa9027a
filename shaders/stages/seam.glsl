// A segment comes to a seam of a domain that repeats. It then has several parts, as within a mesh: each ends at a seam, and what is
// left of its optical depth is carried over to the next.
#ifndef STAGE_SEAM_GLSL
#define STAGE_SEAM_GLSL
#include "stages/count.glsl"

// A segment is about to begin, wherever that is.
void enter_domain(bool looks, inout Lane lane) {
    float before;
    vec3 position = place_in_domain(looks ? looking_from(lane) : lane.path.position,
                                    looks ? looking_along(lane) : lane.path.direction, before);
    if (COUNTS_PASSING)
        if (is_particle(lane))
            count_passing(lane.path.position, true, position, lane);
    lane.position = looks ? position : lane.position;
    lane.path.position = looks ? lane.path.position : position;
    lane.flown = looks ? lane.flown : before;
    lane.seams = 0u;
}

const uint STEPS_OF_SEAM = 64u; // as many as it counts for: a level ray through nothing is cut after a million domains

// True, if what ended was but a part: then the path, or what looks, is across, where the next one begins; unless it is cut.
bool passes_seam(bool looks, inout uint event, inout Lane lane, inout Tally tally) {
    vec3 from = looks ? looking_from(lane) : lane.path.position;
    vec3 direction = looks ? looking_along(lane) : lane.path.direction;
    ivec3 axis;
    float t = seam_ahead(from, direction, looks ? FAR : reach_of_flight(lane), axis);
    if (t == FAR)
        return false;
    vec3 across = beyond_seam(from, direction, t, axis);
    lane.position = looks ? across : lane.position;
    lane.path.position = looks ? lane.path.position : across;
    lane.flown += looks ? 0.0 : t;
    lane.seams = 1u;
    lane.steps += STEPS_OF_SEAM;
    bool cut = lane.steps >= push.step_limit;
    event = cut ? EVENT_CUT : event;
    tally.step_caps += cut ? 1u : 0u;
    return !cut;
}

#endif
