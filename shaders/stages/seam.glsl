// A segment comes to a seam of a domain that repeats. It then has several parts, as within a mesh: each ends at a seam, and what is
// left of its optical depth is carried over to the next.
#ifndef STAGE_SEAM_GLSL
#define STAGE_SEAM_GLSL
#include "stages/lane.glsl"

// A segment is about to begin, wherever that is.
void enter_domain(bool looks, inout Lane lane) {
    float before;
    vec3 position = place_in_domain(looks ? looking_from(lane) : lane.path.position,
                                    looks ? looking_along(lane) : lane.path.direction, before);
    lane.position = looks ? position : lane.position;
    lane.path.position = looks ? lane.path.position : position;
    lane.flown = looks ? lane.flown : before;
    lane.seams = 0u;
}

// True, if what ended was but a part: then the path, or what looks, is across, where the next one begins.
bool passes_seam(bool looks, inout Lane lane) {
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
    return true;
}

#endif
