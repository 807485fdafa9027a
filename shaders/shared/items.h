// What lives in device buffers between passes.
#ifndef SHARED_ITEMS_H
#define SHARED_ITEMS_H
#include "shared/prologue.h"

SHARED_BEGIN

// A pixel in work, one slot each, and the path in flight in it, at its last vertex: the camera, or a real collision. Of
// a pixel not begun there are its index and place, and the rest says nothing yet. The path's throughput beta is in a
// buffer of its own, since its type depends on the scene; at a collision it includes that collision's albedo.
struct PathState {
    vec3 position;  // render space
    vec3 direction; // unit, of travel: the camera ray's, or that which led to this collision
    vec3 radiance;  // gathered so far
    uint pixel;     // index into the film
    uint place;     // of the pixel in the picture, x | y << 16
    uint sample_index;
    uint draw;      // random draws consumed; 0 at the camera, whose draw also holds the first free flight
    uint depth;     // scattering events, this one included; 0 at the camera
    uint suspended; // 1: there is more to know of it, see Suspended; 0: it is about to depart from the vertex
};

// A segment, free flight or shadow ray, as far as it has gone. Which fields mean something depends on the estimator.
struct Walk {
    vec3 origin;     // medium space, where the present part of the ray within the medium begins
    vec3 direction;  // what one world unit of travel becomes in medium space
    float start;     // of that part, from the vertex [world units]
    float t_end;     // its length
    float t;         // travelled in it
    float at;        // where in it the last interaction was
    float tau;       // optical depth left: of the majorant, or, where no collision is null, of the medium
    float depth;     // density integrated so far, over all parts
    float sigma_maj; // of the present cell [1 / world unit]; if it is empty, minus its reach, see majorant.glsl
    float control;   // control density of the present cell
    ivec3 cell;      // majorant cell; the voxel in regular tracking
    float dt;        // marches: length of a step
    uint index;      // marches: the next step
    uint level;      // telescoping: the refinement
    uint residue;    // telescoping: which samples the coarser sums take
    float offset;    // telescoping: of the samples in their steps
    float coarse;    // telescoping: density integrated with half of the samples
    float base;      // telescoping: with the coarsest set of samples
};

// A search for the next part of a ray within meshes, as far as it has gone; see mesh.glsl.
struct PartSearch {
    uint stage;   // SEARCH_...
    float t_from; // beyond which
    uint node;    // of the hierarchy, to be visited next
    int winding;  // bodies that the ray is inside of just behind t_from, by the crossings found so far
    float first;  // distance to the first crossing, or infinitely far
    int turn;     // surfaces left less those entered there
    float second; // distance to the next crossing behind that, or infinitely far
};

// A path laid aside amid a segment, when its lane's budget was spent.
struct Suspended {
    Walk walk;
    Walk flight;   // to come back to from a shadow ray that was sent amid a flight
    vec3 T;        // of the shadow ray so far
    vec3 lit;      // throughput of what it lights
    vec3 position; // where it began, render space
    uint todo;
    uint resume;
    uint steps;   // of the segment
    vec3 cached;  // transmittance that the shadow ray corrects
    float chance; // with which it was sent
    PartSearch search;
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

// What happened since the host last read them; 32 bits hold one submit's worth.
struct Counters {
    uint next_work;  // pixels of the batch's work list handed out so far
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
