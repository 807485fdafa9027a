// Render pixels: all samples of one, path after path, from vertex to vertex: free flights, shadow rays, scattering.
//
// One flat loop: a lane has a pixel and steps along its path's present segment, free flight or shadow ray alike, since
// most are walks over majorant cells with tentative collisions. When a segment ends it begins the next, when the path
// ends the next sample's; sums stay in registers. So lanes with short and long paths, looking or flying, share every
// iteration. A pass of its own for shadow rays cost each path one round of all passes per vertex, and ran at a fifth of
// this speed on a software driver; passes of their own to begin and to add up each path, half the time of thin media.
//
// Pixels change hands between bursts of turns only: every turn of every lane pays for what a turn might do, and a queue
// is dear. When a lane's budget is spent its path is laid aside as it stands, amid a segment or not, and nothing
// depends on where that was.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "lib/queue.glsl"
#include "stages/accumulate.glsl"
#include "stages/collide.glsl"
#include "stages/depart.glsl"
#include "stages/escape.glsl"
#include "stages/generate.glsl"
#include "stages/shadow.glsl"
#include "stages/track.glsl"

const uint BURST = 16u; // turns: a lane without a pixel waits for half as many

// What the present segment met, if anything, and what follows.
void arrive(VolumeParams v, uint event, Spectrum deposit, inout Lane lane, inout Rng rng, inout Tally tally) {
    bool seeing = LOOKS && lane.todo == TODO_SEE;
    bool cut = event == EVENT_MOVING && (seeing || lane.todo == TODO_FLY) && lane.steps >= push.step_limit;
    tally.step_caps += cut ? 1u : 0u; // loses light, and is counted
    if (seeing && (cut || event != EVENT_MOVING))
        end_shadow(v, event, lane);
    else if (cut)
        lane.todo = TODO_END;
    else if (event == EVENT_LEFT)
        escape(v, lane);
    else if (event == EVENT_COLLIDED)
        collide(v, deposit, lane, rng, tally);
    else if (event == EVENT_TOUCHED)
        touch(v, deposit, lane, rng);
}

// All stages, one after another, of a lane that is at any of them.
void turn(VolumeParams v, inout Lane lane, inout Rng rng, inout FilmPixel sums, inout Tally tally) {
    if (lane.todo == TODO_BEGIN)
        generate(lane, rng);
    if (lane.todo == TODO_DEPART || lane.todo == TODO_LOOK)
        depart(v, lane, rng, tally);
    Spectrum deposit = to_spectrum(vec3(0.0));
    uint event = EVENT_MOVING;
    uint steps = tally.steps;
    if (lane.todo == TODO_FLY || lane.todo == TODO_SEE)
        event = track(v, lane, rng, deposit, tally);
    lane.steps += tally.steps - steps;
    arrive(v, event, deposit, lane, rng, tally);
    if (lane.todo == TODO_END)
        accumulate(sums, lane, tally);
}

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
        take_up(slot, lane);
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
        for (uint k = 0u; k < turns; ++k)
            turn(v, lane, rng, sums, tally);
        if (lane.todo == TODO_DONE) {
            film[paths[slot].pixel] = sums;
            push_item(QUEUE_GENERATE, slot);
            lane.todo = TODO_TAKE;
        }
    }
    if (lane.todo != TODO_TAKE) {
        film[paths[slot].pixel] = sums;
        lay_aside(slot, rng, lane);
        push_item(QUEUE_RESUME, slot);
    }
    add_tally(tally);
}
