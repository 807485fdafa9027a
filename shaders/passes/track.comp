// Follow paths from vertex to vertex: free flights, shadow rays, scattering.
//
// One flat loop: a lane takes a path from the queue and steps along its present segment, free flight or shadow ray
// alike, since both are walks over majorant cells with tentative collisions. When a segment ends it begins the next;
// when the path ends it takes another at once. So lanes with short and long paths, looking or flying, share every
// iteration. A pass of its own for shadow rays cost each path one round of all passes per vertex, and ran at a
// fifth of this speed on a software driver.
//
// A path is put back only at a vertex, when its lane's budget is spent: so the state that travels is small, and
// nothing depends on where the budget ran out.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../include/pass.glsl"

#include "../include/camera.glsl"
#include "../include/emission.glsl"
#include "../include/free_flight.glsl"
#include "../include/light.glsl"
#include "../include/queue.glsl"
#include "../include/transmittance.glsl"

// What a lane does next.
#define TODO_TAKE 0u  // take a path from the queue
#define TODO_DEPART 1u // from a vertex: scatter, unless it is the camera, and fly
#define TODO_LOOK 2u   // from a vertex toward the light
#define TODO_FLY 3u    // go on along the flight
#define TODO_SEE 4u    // go on along the shadow ray

#define EVENT_STOPPED 3u // the path ended before it flew

// Russian roulette on the throughput: unbiased, survivors are raised to the threshold.
bool survives(inout float beta, float u) {
    if (beta >= frame.roulette_threshold)
        return true;
    bool alive = u * frame.roulette_threshold < beta;
    beta = frame.roulette_threshold;
    return alive;
}

// The walk along the volume's part of a ray from a vertex or the camera; `t_enter` is where that part begins.
Walk begin_segment(VolumeParams v, vec3 position, vec3 direction, float tau, out float t_enter) {
    Ray ray = to_medium(v, position, direction);
    vec2 t;
    if (!intersect_volume(v, ray, t))
        t = vec2(0.0); // a vertex on the boundary, heading out
    t_enter = t.x;
    return begin_walk(v, ray, t, tau);
}

// Homogeneous: the transmittance to the light is known at once.
vec3 analytic_sun(VolumeParams v, PathState path) {
    vec2 t;
    if (!intersect_volume(v, to_medium(v, path.position, frame.light.direction), t))
        t.y = 0.0;
    return sun_contribution(v, frame.light, path.direction, path.beta) * analytic_transmittance(v, t.y);
}

uint step_segment(VolumeParams v, inout Walk walk, inout Rng rng, bool seeing, inout float T, inout Tally tally) {
    if (FREE_FLIGHT == FREE_FLIGHT_ANALYTIC) {
        uint flown = analytic_flight(v, walk);
        tally.real_collisions += flown == EVENT_COLLIDED ? 1u : 0u;
        return flown;
    }
    Collision c;
    uint event = next_collision(v, walk, rng, tally, c);
    if (event == EVENT_COLLIDED)
        event = seeing ? resolve_transmittance(c, T, tally) : resolve_flight(c, tally);
    return event;
}

void main() {
    VolumeParams v = frame.volume;
    Tally tally = Tally(0u, 0u, 0u, 0u, 0u, 0u, 0u);
    uint slot = 0u;
    uint todo = TODO_TAKE;
    PathState path;
    Rng rng;
    Walk walk;
    float t_enter = 0.0;
    float T = 1.0;
    uint segment_steps = 0u;
    for (uint i = 0u; i < push.budget + push.step_limit; ++i) {
        bool over_budget = i >= push.budget;
        if (todo == TODO_DEPART && over_budget) {
            path.draw = rng.draw;
            paths[slot] = path;
            push_item(QUEUE_TRACK, slot);
            todo = TODO_TAKE;
        }
        if (todo == TODO_TAKE) {
            if (over_budget || !pop_item(QUEUE_TRACK, slot))
                break;
            path = paths[slot];
            rng = pixel_rng(path.pixel, path.sample_index, path.draw);
            todo = TODO_DEPART;
        }
        bool ended = false;
        if (todo == TODO_DEPART || todo == TODO_LOOK) {
            vec4 u = to_uniform(next_words(rng));
            bool looks = NEE != NEE_NONE && todo == TODO_LOOK;
            bool at_camera = path.depth == 0u;
            if (!looks && !at_camera) {
                path.direction = hg_sample(v.g, path.direction, u.yz);
                ended = !survives(path.beta, u.w);
            }
            walk = begin_segment(v, path.position, looks ? frame.light.direction : path.direction,
                                 to_exponential(at_camera ? u.z : u.x), t_enter);
            todo = looks ? TODO_SEE : TODO_FLY;
            tally.shadow_rays += looks ? 1u : 0u;
            T = 1.0;
            segment_steps = 0u;
        }
        bool seeing = NEE != NEE_NONE && todo == TODO_SEE;
        uint event = ended ? EVENT_STOPPED : EVENT_MOVING;
        for (int k = 0; k < STEPS && event == EVENT_MOVING; ++k)
            event = step_segment(v, walk, rng, seeing, T, tally);
        segment_steps += STEPS;
        if (event == EVENT_MOVING && segment_steps >= push.step_limit) { // loses light, and is counted
            tally.step_caps += 1u;
            T = 0.0;
            event = seeing ? EVENT_LEFT : EVENT_STOPPED;
            ended = !seeing;
        }
        if (seeing && event == EVENT_LEFT) {
            if (T != 0.0)
                path.radiance += T * sun_contribution(v, frame.light, path.direction, path.beta);
            todo = TODO_DEPART;
        } else if (event == EVENT_LEFT) {
            path.radiance += path.beta * frame.background;
            ended = true;
        } else if (event == EVENT_COLLIDED) {
            path.position += (t_enter + walk.t) * path.direction;
            if (EMISSION != EMISSION_NONE)
                path.radiance += path.beta * emitted_radiance(v.emission, path.position);
            path.beta *= v.albedo;
            bool capped = path.depth >= frame.max_depth;
            tally.depth_caps += capped ? 1u : 0u;
            ended = capped || path.beta == 0.0;
            path.depth += 1u;
            if (NEE != NEE_NONE && TRANSMITTANCE == TRANSMITTANCE_ANALYTIC && !ended)
                path.radiance += analytic_sun(v, path);
            todo = NEE != NEE_NONE && TRANSMITTANCE != TRANSMITTANCE_ANALYTIC ? TODO_LOOK : TODO_DEPART;
        }
        if (ended) {
            path.draw = rng.draw;
            paths[slot] = path;
            push_item(QUEUE_ACCUMULATE, slot);
            todo = TODO_TAKE;
        }
    }
    add_tally(tally);
}
