// Before a flight or shadow ray begins: the surface that ends it, or whether one is in its way. Then it sets out, a flight where
// there are looks from along it after these.
#ifndef STAGE_SEEK_GLSL
#define STAGE_SEEK_GLSL
#include "stages/depart.glsl"
#include "stages/shadow.glsl"

#ifdef SURFACES
// Goes on with the search for some nodes. What is in the way of a shadow ray ends it, and the search.
void seek(MediumParams v, inout Lane lane, inout Rng rng, inout Tally tally) {
    bool looks = at_shadow_ray(lane.todo == TODO_CHECK);
    Ray ray = Ray(looks ? looking_from(lane) : lane.path.position, looks ? looking_along(lane) : lane.path.direction);
    uint from = begins_at(looks, lane);
    MeshRay mesh_ray = make_mesh_ray(frame.first_surface_node, frame.surface_nodes, ray);
    float reach = looks && !REPEATS ? looking_as_far_as(lane) : FAR;
    bool over = looks && lane.seek.primitive != NO_SURFACE;
#ifdef RAY_QUERY
    bool passes = reach < FAR && over && lies_in(lane.seek.primitive, ray, lane.seek.nearest, reach); // a plane
    lane.seek.primitive = passes ? NO_SURFACE : lane.seek.primitive;
    lane.seek.nearest = passes ? seeking_as_far_as(lane) : lane.seek.nearest;
    ask_boxes(mesh_ray, ray, from, looks ? lane.lamp_body : NO_SURFACE, looks, reach, lane.seek);
    over = true;
#else
    for (int k = 0; k < SURFACE_NODES_PER_TURN && !over; ++k) {
        over = step_seek(mesh_ray, ray, from, looks ? lane.lamp_body : NO_SURFACE, lane.seek);
        over = over || (looks && lane.seek.primitive != NO_SURFACE);
    }
    // What the light lies in is passed over, and the search goes on (but for what else is in that leaf). A loop, since software
    // drivers do both sides of an `if`; it is entered once for what a look meets.
    for (bool met = reach < FAR && over && lane.seek.primitive != NO_SURFACE; met; met = false) {
        bool passes = lies_in(lane.seek.primitive, ray, lane.seek.nearest, reach);
        lane.seek.primitive = passes ? NO_SURFACE : lane.seek.primitive;
        lane.seek.nearest = passes ? seeking_as_far_as(lane) : lane.seek.nearest;
        over = !passes || lane.seek.node >= frame.surface_nodes;
    }
#endif
    if (over && looks && lane.seek.primitive != NO_SURFACE) {
        end_shadow(v, EVENT_OPAQUE, lane);
    } else if (over) {
        lane.reach = looks ? lane.reach : lane.seek.nearest;
        lane.struck = looks ? lane.struck : lane.seek.primitive;
        lane.todo = looks ? TODO_SEE : TODO_FLY;
        bool goes_to_look = false;
        if (LOOKS_ALONG)
            if (!looks)
                goes_to_look = look_along(v, lane, rng, tally);
        if (REPEATS && lane.seams != 0u)
            begin_here(v, looks, lane);
        else if (!goes_to_look)
            set_going(v, next_words(rng), looks, false, lane);
    }
}
#endif

#endif
