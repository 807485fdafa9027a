// The staged schedule: shadow rays, until their light has been added to the path's, or the lanes' budget is spent.
#version 460
#extension GL_GOOGLE_include_directive : require
#define SHADOW_RAYS_ONLY
#include "lib/pass.glsl"

#include "stages/staged.glsl"

void main() {
    run_segments(QUEUE_SHADOW, QUEUE_LOOK);
}
