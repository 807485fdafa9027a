// The staged schedule: flights, collisions and what follows from them at once, until a path sends a shadow ray, or is over,
// or the lanes' budget is spent.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FLIGHTS_ONLY
#include "lib/pass.glsl"

#include "stages/send.glsl"
#include "stages/turn.glsl"

const uint BURST = 4u; // turns: a lane without a path waits for half as many

void main() {
    MediumParams v = frame.media[0];
    Tally tally = NOTHING_SEEN;
    uint slot = 0u;
    Rng rng;
    Lane lane;
    lane.todo = TODO_TAKE;
    if (pop_item(QUEUE_RESUME, slot))
        take_up(slot, lane, rng, true);
    for (uint i = 0u; i < push.budget; i += BURST) {
        if (lane.todo == TODO_TAKE) {
            if (!pop_item(QUEUE_TRACK, slot))
                break;
            take_up(slot, lane, rng, COMES_AMID);
        }
        uint turns = min(BURST, push.budget - i);
        tally.room += turns * uint(STEPS);
        for (uint k = 0u; k < turns; ++k)
            turn(v, lane, rng, tally);
        if (lane.todo != TODO_TAKE && !departs(lane.todo) && !is_under_way(lane.todo))
            send(slot, rng, lane);
    }
    if (lane.todo != TODO_TAKE) {
        lay_aside(slot, lane.path.pixel, rng, lane, true);
        push_item(QUEUE_RESUME, slot);
    }
    add_tally(tally);
}
