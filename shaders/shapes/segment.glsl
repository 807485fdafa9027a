// Segments: what flights and shadow rays have in common. Both cross the medium part by part; a mesh that is not convex
// has several, and the optical depth left is carried over from one to the next. Spheres and boxes have one, which is
// known at once; a mesh's parts are searched for, some nodes of its hierarchy at a time.
#ifndef SEGMENT_GLSL
#define SEGMENT_GLSL
#include "estimators/free_flight.glsl"
#include "estimators/transmittance.glsl"

// Where a shadow ray is a walk of its own; that of a homogeneous medium of one part, or of several, is known at once, where no
// surface and no seam can be in the way. (In bits,
// since glslang 12 branches for nested `&&` and `||`, and takes the outcome for a constant nevertheless.)
const bool SHADOW_RAYS_WALK =
    (int(NEE != NEE_NONE) &
     (int((SHADOW_TRAITS & TRAIT_CLOSED) == 0) | int(SHAPE == SHAPE_MESH) | int(HAS_SURFACES) | int(REPEATS))) != 0;

// What the scene's estimators need of a walk that is laid aside: what rows of WALK_STATE ask for.
#define WALK_CONDITIONS                                                                                               \
    int shadow_traits = SHADOW_RAYS_WALK ? SHADOW_TRAITS : 0;                                                         \
    int traits = FLIGHT_TRAITS | shadow_traits;                                                                       \
    bool marches = (FLIGHT_TRAITS & TRAIT_EQUAL_STEPS) != 0 || (shadow_traits & TRAIT_MARCH) != 0;                    \
    bool adds_depth = !NULL_FLIGHT || (SHADOW_RAYS_WALK && !NULL_TRANSMITTANCE);                                      \
    bool walks = (traits & TRAIT_CELLS) != 0;                                                                         \
    bool cells = (traits & TRAIT_VOXELS) != 0 || (walks && HAS_CELLS);                                                \
    bool listed = SEVERAL_MEDIA, bricks = CELL_BITS != 0, splits = SPLITS;                                            \
    bool controlled = (traits & TRAIT_CONTROL) != 0;                                                                  \
    bool sets = (traits & TRAIT_SETS) != 0;

// How far a segment may go, where that is not for the medium alone to say: a shadow ray, to a light that is not infinitely far.
float cut_short(float t, float reach) {
    return LIGHTS == LIGHTS_LONE ? t : min(t, reach);
}

// The part of the segment within the medium that begins at t.x.
void begin_part(MediumParams v, Ray ray, vec2 t, bool seeing, inout Walk w) {
    w.origin = ray.origin + t.x * ray.direction;
    w.direction = ray.direction;
    w.start = t.x;
    w.t_end = t.y - t.x;
    w.t = 0.0;
    w.at = 0.0;
    w.met = 0u;
    if (SHADOW_RAYS_WALK && seeing)
        begin_transmittance_part(v, w);
    else
        begin_flight_part(v, w);
}

// A vertex on the boundary, heading out, has no such part, nor a camera ray that misses: then an empty one, which the
// first step leaves. Of a mesh, the search for it only begins.
void begin_segment(MediumParams v, vec3 position, vec3 direction, float reach, bool seeing, inout Walk w,
                   inout PartSearch search) {
    search.stage = SEARCH_OVER;
    if (SHAPE == SHAPE_MESH) {
        search = begin_search(SEARCH_FIRST, 0.0);
    } else {
        Ray ray = to_medium(v, position, direction);
        vec2 t;
        if (!medium_interval(v, ray, t))
            t = vec2(0.0);
        t.y = cut_short(t.y, reach);
        t.x = min(t.x, t.y);
        begin_part(v, ray, t, seeing, w);
    }
}

// What `event` of a step means for the segment: where a part of a mesh has ended there may be a further one.
uint after_step(uint event, Walk w, float reach, inout PartSearch search) {
    bool searches = SHAPE == SHAPE_MESH && event == EVENT_LEFT && search.stage == SEARCH_OVER;
    searches = searches && (LIGHTS == LIGHTS_LONE || w.start + w.t_end < reach);
    if (searches)
        search = begin_search(SEARCH_NEXT, w.start + w.t_end);
    return searches ? EVENT_MOVING : event;
}

bool is_searching(PartSearch search) {
    return SHAPE == SHAPE_MESH && (search.stage == SEARCH_FIRST || search.stage == SEARCH_NEXT);
}

// Goes on with a search for some nodes. Where it ends, the segment is in the next part, or has left the medium.
uint search_part(MediumParams v, vec3 position, vec3 direction, float reach, bool seeing, inout Walk w,
                 inout PartSearch search) {
    uint event = EVENT_MOVING;
    // A loop, since software drivers do both sides of an `if`: a group none of whose lanes searches passes it by.
    for (bool begins = is_searching(search); begins; begins = false) {
        Ray ray = to_medium(v, position, direction);
        MeshRay mesh_ray = make_mesh_ray(0u, v.bvh_nodes, ray);
        vec2 t;
        bool over = false;
        for (int k = 0; k < MESH_NODES_PER_TURN && !over; ++k)
            over = step_search(v.bvh_nodes, mesh_ray, search, t);
        if (over && LIGHTS != LIGHTS_LONE) {
            t.y = cut_short(t.y, reach);
            t.x = min(t.x, t.y); // the first part may begin behind the lamp
        }
        bool found = over && t.x < t.y;
        if (over && (found || search.stage == SEARCH_FIRST))
            begin_part(v, ray, t, seeing, w);
        event = over && !found && search.stage == SEARCH_NEXT ? EVENT_LEFT : EVENT_MOVING;
        search.stage = found ? SEARCH_OVER : over ? SEARCH_EMPTY : search.stage;
    }
    return event;
}

// Transmittance of a homogeneous sphere or box, of several, or of an exponential, up to a distance of `reach`.
Spectrum transmittance_to(MediumParams v, vec3 position, vec3 direction, float reach) {
#ifdef SEVERAL
    return analytic_transmittance(v, depth_of_all(position, direction, cut_short(FAR, reach)));
#else
    vec2 t;
    Ray ray = to_medium(v, position, direction);
    float inside = medium_interval(v, ray, t) ? cut_short(t.y, reach) - t.x : 0.0;
    inside = max(inside, 0.0);
    if (LAYERED)
        inside = faded_depth(fading_along(v, ray.origin + t.x * ray.direction, ray.direction), inside);
    return analytic_transmittance(v, inside);
#endif
}

#endif
