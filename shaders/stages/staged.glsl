// The staged schedule's passes over segments: their lanes take paths from `queue`, first those that were laid aside, and
// pass them on.
#ifndef STAGE_STAGED_GLSL
#define STAGE_STAGED_GLSL
#include "stages/send.glsl"
#include "stages/turn.glsl"

const uint BURST = STAGED_BURST; // turns: a lane without a path waits for half as many

void run_segments(const uint queue, const uint laid_aside) {
    MediumParams v = frame.media[0];
    Tally tally = NOTHING_SEEN;
    uint slot = 0u;
    Rng rng;
    Lane lane;
    lane.todo = TODO_TAKE;
    if (pop_item(laid_aside, slot)) {
        take_up(slot, lane, rng, true);
        lane.record = waiting_place(lane.path);
    }
    for (uint i = 0u; i < push.budget; i += BURST) {
        if (lane.todo == TODO_TAKE) {
            if (!pop_item(queue, slot))
                break;
            take_up(slot, lane, rng, COMES_AMID);
            lane.record = waiting_place(lane.path);
        }
        uint turns = min(BURST, push.budget - i);
        tally.room += turns * uint(STEPS);
        for (uint k = 0u; k < turns; ++k)
            turn(v, lane, rng, tally);
        if (lane.todo != TODO_TAKE && !departs(lane.todo) && !seeks(lane.todo) && !is_under_way(lane.todo))
            send(slot, rng, lane);
    }
    if (lane.todo != TODO_TAKE) {
        lay_aside(slot, lane.path.pixel, rng, lane, true);
        push_item(laid_aside, slot);
    }
    add_tally(tally);
}

#endif
