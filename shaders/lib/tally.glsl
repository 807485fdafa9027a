// What a lane has seen, kept in registers and added to the counters once.
#ifndef TALLY_GLSL
#define TALLY_GLSL
#include "lib/buffers.glsl"

struct Tally {
    uint paths;
    uint real_collisions;
    uint null_collisions;
    uint lookups;
    uint cells;
    uint shadow_rays;
    uint room;
    uint steps;
    uint depth_caps;
    uint step_caps;
    uint violations;
    uint non_finite;
    uint dropped_place; // of the first sample that was not finite
    uint dropped_sample;
};

const Tally NOTHING_SEEN = Tally(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);

// `place`, `sample_index`: of the first.
void count_dropped(uint samples, uint place, uint sample_index) {
    atomicAdd(counters.non_finite, samples);
    uint record = atomicAdd(counters.non_finite_records, 1u);
    if (record < NON_FINITE_RECORDS) {
        counters.non_finite_place[record] = place;
        counters.non_finite_sample[record] = sample_index;
    }
}

// What film_add has seen.
void add_film_tally(Tally tally) {
    atomicAdd(counters.paths, tally.paths);
    if (tally.non_finite != 0u)
        count_dropped(tally.non_finite, tally.dropped_place, tally.dropped_sample);
}

void add_all(Tally tally) {
    atomicAdd(counters.paths, tally.paths);
    atomicAdd(counters.real_collisions, tally.real_collisions);
    atomicAdd(counters.null_collisions, tally.null_collisions);
    atomicAdd(counters.lookups, tally.lookups);
    atomicAdd(counters.cells, tally.cells);
    if (NEE != NEE_NONE)
        atomicAdd(counters.shadow_rays, tally.shadow_rays);
    atomicAdd(counters.room, tally.room);
    atomicAdd(counters.steps, tally.steps);
    if (tally.depth_caps != 0u)
        atomicAdd(counters.depth_caps, tally.depth_caps);
    if (tally.step_caps != 0u)
        atomicAdd(counters.step_caps, tally.step_caps);
    if (tally.violations != 0u)
        atomicAdd(counters.majorant_violations, tally.violations);
}

// Where a driver writes out each access to memory for every lane: the same by one.
void add_in_loop(Tally t) {
    uint seen[TALLIED] = uint[](t.paths, t.real_collisions, t.null_collisions, t.lookups, t.cells, t.shadow_rays, t.room, t.steps,
                                t.depth_caps, t.step_caps, t.violations);
    for (uint i = 0u; i < by_lane(uint(TALLIED)); ++i)
        atomicAdd(counter_words[uint(TALLY_FIRST) + i], seen[i]);
}

void add_tally(Tally tally) {
    if (COPIES != 0)
        add_in_loop(tally);
    else
        add_all(tally);
    if (tally.non_finite != 0u)
        count_dropped(tally.non_finite, tally.dropped_place, tally.dropped_sample);
}

#endif
