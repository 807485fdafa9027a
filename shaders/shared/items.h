// What lives in device buffers between passes.
#ifndef SHARED_ITEMS_H
#define SHARED_ITEMS_H
#include "shared/path_state.h"
#include "shared/constants.h"
#include "shared/prologue.h"

SHARED_BEGIN

#define STATE_FIELD(type, name) type name;
#define STATE_FIELD_WHEN(type, name, when) type name;

// A path at its last vertex, and what it knows of its segment. In memory they are words: see laid_aside.glsl. Of a pixel in work of
// which no sample has begun (fused) there are its index and place, and the rest says nothing yet.
struct PathState {
    VERTEX_STATE(STATE_FIELD)
};

struct Walk {
    WALK_STATE(STATE_FIELD_WHEN)
};

struct PartSearch {
    SEARCH_STATE(STATE_FIELD)
};

struct SurfaceSearch {
    SEEK_STATE(STATE_FIELD)
};

// Staged: a place among the samples that wait to be added to the film, in order, for one pixel after another.
struct SamplePlace {
    uint tenants; // pixels that have had the place
    uint added;   // samples of the present one that are in the film
};

// A ring of slot numbers. Items of queue q start at q * capacity; positions grow without end and wrap modulo the
// capacity and modulo 2^32, so differences are taken as signed numbers.
struct QueueHeader {
    uint head;     // next to be taken; runs past `limit` when lanes find nothing more
    uint tail;     // next to be written
    uint limit;    // the tail when the consuming pass began: what is pushed later waits for the next round
    uint base;     // the head at that time
    uint groups_x; // VkDispatchIndirectCommand of the consuming pass
    uint groups_y;
    uint groups_z;
};

// Sums of radiance and of its square, each as an unevaluated pair high + low, so that long sums do not stall.
struct FilmPixel {
    vec3 sum;
    vec3 sum_low;
    vec3 square;
    vec3 square_low;
    uint count;
};

#define NON_FINITE_RECORDS 4

// Words of Counters that a Tally has, as it has them: so many, from here on.
#define TALLY_FIRST 2
#define TALLIED 11

// What happened since the host last read them; 32 bits hold one submit's worth.
struct Counters {
    uint next_work;  // of the batch's work list handed out so far: pixels (fused) or samples (staged); may run past the end
    uint work_count; // pixels in that list: those in which a sample may meet the medium
    uint paths;      // finished, including those that never met the medium
    uint real_collisions;
    uint null_collisions;
    uint lookups; // of the density
    uint cells;   // steps of a walk or march that were no collision
    uint shadow_rays;
    uint room;                // for steps that the lanes of the track pass had, those without a path included
    uint steps;               // that took a path further
    uint depth_caps;          // paths ended by maxDepth
    uint step_caps;           // flights ended by the step limit
    uint majorant_violations; // density above its majorant
    uint non_finite;          // samples dropped
    uint queue_overflows;     // items dropped; always 0 unless the program is wrong
    uint queued[QUEUE_COUNT]; // items that were in each queue when its pass began, over all rounds
    uint non_finite_records;  // some of them, and where they were in the picture: x | y << 16
    uint non_finite_place[NON_FINITE_RECORDS];
    uint non_finite_sample[NON_FINITE_RECORDS];
};

// A vertex of the path that is followed; see TRACE_...
struct TraceRecord {
    uint kind;
    uint depth;     // scattering events so far
    uint steps;     // of the segment that led here
    vec3 position;  // render space
    vec3 direction; // of travel
    vec3 beta;
    vec3 T;        // of the shadow ray, where one has ended
    vec3 radiance; // gathered so far
};

SHARED_END
#endif
