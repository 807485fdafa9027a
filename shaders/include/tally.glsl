// What a lane has seen, kept in registers and added to the counters once.
#ifndef TALLY_GLSL
#define TALLY_GLSL
#include "buffers.glsl"

struct Tally {
    uint real_collisions;
    uint null_collisions;
    uint lookups;
    uint cells;
    uint shadow_rays;
    uint violations;
    uint depth_caps;
    uint step_caps;
};

const Tally NOTHING_SEEN = Tally(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);

void add_tally(Tally tally) {
    atomicAdd(counters.real_collisions, tally.real_collisions);
    atomicAdd(counters.null_collisions, tally.null_collisions);
    atomicAdd(counters.lookups, tally.lookups);
    atomicAdd(counters.cells, tally.cells);
    if (NEE != NEE_NONE)
        atomicAdd(counters.shadow_rays, tally.shadow_rays);
    if (tally.violations != 0u)
        atomicAdd(counters.majorant_violations, tally.violations);
    if (tally.depth_caps != 0u)
        atomicAdd(counters.depth_caps, tally.depth_caps);
    if (tally.step_caps != 0u)
        atomicAdd(counters.step_caps, tally.step_caps);
}

#endif
