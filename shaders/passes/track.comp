// Follow paths from vertex to vertex: free flights, shadow rays, scattering.
//
// One flat loop: a lane takes a path from the queue and steps along its present segment, free flight or shadow ray
// alike, since most are walks over majorant cells with tentative collisions. When a segment ends it begins the next;
// when the path ends it takes another at once. So lanes with short and long paths, looking or flying, share every
// iteration. A pass of its own for shadow rays cost each path one round of all passes per vertex, and ran at a
// fifth of this speed on a software driver.
//
// When a lane's budget is spent its path is laid aside as it stands, amid a segment or not, and nothing depends on
// where that was.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../include/pass.glsl"

#include "../include/lane.glsl"
#include "../include/queue.glsl"
#include "../include/trace.glsl"

void main() {
    VolumeParams v = frame.volume;
    Tally tally = NOTHING_SEEN;
    uint slot = 0u;
    Rng rng;
    Lane lane;
    lane.todo = TODO_TAKE;
    // What was laid aside is taken up here, once, and not in the loop: there every iteration would pay for it.
    if (pop_item(QUEUE_RESUME, slot)) {
        resume(slot, lane);
        rng = pixel_rng(lane.path.place, lane.path.sample_index, lane.path.draw);
    }
    for (uint i = 0u; i < push.budget; ++i) {
        if (lane.todo == TODO_TAKE) {
            if (!pop_item(QUEUE_TRACK, slot))
                break;
            begin_path(slot, lane);
            rng = pixel_rng(lane.path.place, lane.path.sample_index, 0u);
        }
        if (lane.todo == TODO_DEPART || lane.todo == TODO_LOOK) {
            bool looks = LOOKS && lane.todo == TODO_LOOK;
            uvec4 words = next_words(rng);
            vec4 u = to_uniform(words);
            bool at_camera = !looks && lane.path.depth == 0u;
            lane.todo = looks ? TODO_SEE : TODO_FLY;
            if (!looks && !at_camera) {
                lane.path.direction = hg_sample(v.g, lane.path.direction, u.yz);
                lane.todo = survives(lane.beta, u.w) ? TODO_FLY : TODO_END;
            }
            if (NEE == NEE_TENTATIVE && looks)
                lane.flight = lane.walk;
            float e = to_exponential(at_camera ? words.z : words.x, words);
            lane.walk.tau = looks ? e : begin_flight(v, lane.beta, e, to_tap(words).z);
            lane.walk.depth = 0.0;
            if (LOOKS && looks)
                begin_transmittance(words, lane.walk);
            begin_segment(v, looks ? looking_from(lane) : lane.path.position,
                          looks ? frame.light.direction : lane.path.direction, looks, lane.walk);
            tally.shadow_rays += looks ? 1u : 0u;
            lane.T = to_spectrum(vec3(1.0));
            lane.steps = 0u;
            if (!looks)
                trace(TRACE_DEPART, lane, lane.path.position, lane.path.direction);
        }
        Spectrum deposit = to_spectrum(vec3(0.0));
        uint event = EVENT_MOVING;
        bool stepping = lane.todo == TODO_FLY || lane.todo == TODO_SEE;
        if (stepping)
            event = step_lane(v, lane, rng, deposit, tally);
        lane.steps += STEPS;
        bool seeing = LOOKS && lane.todo == TODO_SEE;
        bool cut = event == EVENT_MOVING && stepping && lane.steps >= push.step_limit;
        tally.step_caps += cut ? 1u : 0u; // loses light, and is counted
        if (seeing && (cut || event != EVENT_MOVING)) {
            Spectrum T = event == EVENT_LEFT ? end_transmittance(v, lane.walk, lane.T) : to_spectrum(vec3(0.0));
            Spectrum more = NEE == NEE_CACHED ? (T - lane.cached) / lane.chance : T;
            lane.path.radiance += sun_contribution(v, frame.light, lane.path.direction, lit_beta(lane) * more);
            lane.T = T;
            trace(TRACE_LIGHT, lane, looking_from(lane), frame.light.direction);
            lane.todo = after_looking(lane);
            if (NEE == NEE_TENTATIVE)
                lane.walk = lane.flight;
        } else if (cut) {
            lane.todo = TODO_END;
        } else if (event == EVENT_LEFT) {
            Spectrum beta = lane.beta;
            if (!NULL_FLIGHT && !goes_through())
                beta *= depth_weight(v, beta, lane.walk.depth, false);
            lane.path.radiance += beta * frame.background;
            trace(TRACE_ESCAPE, lane, lane.path.position, lane.path.direction);
            lane.todo = TODO_END;
        } else if (event == EVENT_COLLIDED) {
            collide(v, deposit, lane, rng, tally);
            trace(TRACE_COLLISION, lane, lane.path.position, lane.path.direction);
        } else if (event == EVENT_TOUCHED) {
            touch(v, deposit, lane, rng);
        }
        if (lane.todo == TODO_END) {
            trace(TRACE_END, lane, lane.path.position, lane.path.direction);
            paths[slot].radiance = lane.path.radiance;
            push_item(QUEUE_ACCUMULATE, slot);
            lane.todo = TODO_TAKE;
        }
    }
    if (lane.todo != TODO_TAKE) {
        lane.path.draw = rng.draw;
        lane.path.suspended = lane.todo == TODO_DEPART ? 0u : 1u;
        suspend(slot, lane);
        push_item(QUEUE_RESUME, slot);
    }
    add_tally(tally);
}
