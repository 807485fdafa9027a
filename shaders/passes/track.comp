// The staged schedule: flights, collisions and what follows from them at once, until a path sends a shadow ray, or is over,
// or the lanes' budget is spent.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FLIGHTS_ONLY
#include "lib/pass.glsl"

#include "stages/staged.glsl"

void main() {
    run_segments(QUEUE_TRACK, QUEUE_RESUME);
}
