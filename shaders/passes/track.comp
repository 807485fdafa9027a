// Render pixels: all samples of one, path after path, from vertex to vertex: free flights, shadow rays, scattering.
//
// One flat loop: a lane has a pixel and steps along its path's present segment, free flight or shadow ray alike, since
// most are walks over majorant cells with tentative collisions. When a segment ends it begins the next, when the path
// ends the next sample's; sums stay in registers. So lanes with short and long paths, looking or flying, share every
// iteration. A pass of its own for shadow rays cost each path one round of all passes per vertex, and ran at a fifth of
// this speed on a software driver; passes of their own to begin and to add up each path, half the time of thin media.
//
// Pixels change hands between bursts of turns only: every turn of every lane pays for what a turn might do, and a queue
// is dear. When a lane's budget is spent its path is laid aside as it stands, amid a segment or not, and nothing depends
// on where that was.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../include/pass.glsl"

#include "../include/film.glsl"
#include "../include/lane.glsl"
#include "../include/queue.glsl"
#include "../include/trace.glsl"

const uint BURST = 16u; // turns: a lane without a pixel waits for half as many

void main() {
    VolumeParams v = frame.volume;
    Tally tally = NOTHING_SEEN;
    uint slot = 0u;
    Rng rng;
    Lane lane;
    FilmPixel sums;
    lane.todo = TODO_TAKE;
    // What was laid aside is taken up here, once, and not in the loop: there every iteration would pay for it.
    if (pop_item(QUEUE_RESUME, slot)) {
        resume(slot, lane);
        rng = pixel_rng(lane.path.place, lane.path.sample_index, lane.path.draw);
        sums = film[lane.path.pixel];
    }
    for (uint i = 0u; i < push.budget; i += BURST) {
        if (lane.todo == TODO_TAKE) {
            if (!pop_item(QUEUE_TRACK, slot))
                break;
            lane.path.place = paths[slot].place;
            lane.path.sample_index = push.sample_begin;
            sums = film[paths[slot].pixel];
            lane.todo = TODO_BEGIN;
        }
        uint turns = min(BURST, push.budget - i);
        tally.room += turns * uint(STEPS);
        for (uint turn = 0u; turn < turns; ++turn) {
            if (lane.todo == TODO_BEGIN) {
                begin_path(lane);
                rng = pixel_rng(lane.path.place, lane.path.sample_index, 0u);
            }
            if (lane.todo == TODO_DEPART || lane.todo == TODO_LOOK) {
                bool looks = LOOKS && lane.todo == TODO_LOOK;
                uvec4 words = next_words(rng);
                vec4 u = to_uniform(words);
                bool at_camera = !looks && lane.path.depth == 0u;
                lane.todo = looks ? TODO_SEE : TODO_FLY;
                if (!looks && !at_camera) {
                    vec3 before = lane.path.direction;
                    lane.path.direction = hg_sample(v.g, before, u.yz);
                    lane.todo = survives(lane.beta, u.w) ? TODO_FLY : TODO_END;
                    if (LOOKS && NEE == NEE_CACHED && lane.path.depth < frame.max_depth)
                        lane.path.radiance -= lane.beta * frame.light.irradiance *
                                              foreseen_light(v, lane.cached, before, lane.path.direction);
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
                film_add(sums, lane.path.radiance, lane.path.place, lane.path.sample_index, tally);
                lane.path.sample_index += 1u;
                lane.todo = lane.path.sample_index < push.sample_end ? TODO_BEGIN : TODO_DONE;
            }
        }
        if (lane.todo == TODO_DONE) {
            film[paths[slot].pixel] = sums;
            push_item(QUEUE_GENERATE, slot);
            lane.todo = TODO_TAKE;
        }
    }
    if (lane.todo != TODO_TAKE) {
        film[paths[slot].pixel] = sums;
        lane.path.draw = rng.draw;
        lane.path.suspended = lane.todo == TODO_DEPART && NEE != NEE_CACHED ? 0u : 1u;
        suspend(slot, lane);
        push_item(QUEUE_RESUME, slot);
    }
    add_tally(tally);
}
