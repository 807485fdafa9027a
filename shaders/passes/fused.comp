// The fused schedule. Render pixels: all samples of one, path after path, from vertex to vertex: free flights, shadow rays, scattering.
//
// One flat loop: a lane has a pixel and steps along its path's present segment, free flight or shadow ray alike, since
// most are walks over majorant cells with tentative collisions. When a segment ends it begins the next, when the path
// ends the next sample's; sums stay in registers. So lanes with short and long paths, looking or flying, share every
// iteration. (The staged schedule has a pass for each: tools/results/README.md compares them.)
//
// Pixels change hands between bursts of turns only: every turn of every lane pays for what a turn might do, and a queue
// is dear. When a lane's budget is spent its path is laid aside as it stands, amid a segment or not, and nothing
// depends on where that was.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "lib/queue.glsl"
#include "stages/accumulate.glsl"
#include "stages/generate.glsl"
#include "stages/laid_aside.glsl"
#include "stages/turn.glsl"

const uint BURST = 16u; // turns: a lane without a pixel waits for half as many

// A path's turns, from its beginning to its sample in the sums.
void turn_of_pixel(MediumParams v, inout Lane lane, inout Rng rng, inout FilmPixel sums, inout Tally tally) {
    if (lane.todo == TODO_BEGIN)
        generate(v, lane, rng);
    turn(v, lane, rng, tally);
    if (lane.todo == TODO_END)
        accumulate(sums, lane, tally);
}

// The slot's next pixel, from its first sample of the batch.
void begin_pixel(uint slot, inout Lane lane, inout FilmPixel sums) {
    lane.path.place = PATH_WORD(slot, PATH_PLACE);
    lane.path.sample_index = push.sample_begin;
    lane.record = slot;
    sums = film[PATH_WORD(slot, PATH_PIXEL)];
    lane.todo = TODO_BEGIN;
}

void main() {
    MediumParams v = frame.media[0];
    Tally tally = NOTHING_SEEN;
    uint slot = 0u;
    Rng rng;
    Lane lane;
    FilmPixel sums;
    lane.todo = TODO_TAKE;
    // What was laid aside is taken up here, once, and not in the loop: there every iteration would pay for it.
    if (pop_item(QUEUE_RESUME, slot)) {
        take_up(slot, lane, rng, true);
        lane.record = slot;
        sums = film[lane.path.pixel];
    }
    const uint burst = min(BURST, 4u * (push.sample_end - push.sample_begin)); // of few samples a pixel is soon done
    for (uint i = 0u; i < push.budget; i += burst) {
        if (lane.todo == TODO_TAKE) {
            if (!pop_item(QUEUE_TRACK, slot))
                break;
            begin_pixel(slot, lane, sums);
        }
        uint turns = min(burst, push.budget - i);
        tally.room += turns * uint(STEPS);
        for (uint k = 0u; k < turns; ++k)
            turn_of_pixel(v, lane, rng, sums, tally);
        if (lane.todo == TODO_DONE) {
            film[PATH_WORD(slot, PATH_PIXEL)] = sums;
            push_item(QUEUE_GENERATE, slot);
            lane.todo = TODO_TAKE;
        }
    }
    if (lane.todo != TODO_TAKE) {
        film[PATH_WORD(slot, PATH_PIXEL)] = sums;
        lay_aside(slot, PATH_WORD(slot, PATH_PIXEL), rng, lane, true);
        push_item(QUEUE_RESUME, slot);
    }
    add_tally(tally);
}
