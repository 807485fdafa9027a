// What lives in device buffers between passes.
#ifndef SHARED_ITEMS_H
#define SHARED_ITEMS_H
#include "prologue.h"

SHARED_BEGIN

// A path in flight, kept only at vertices: the camera's, or a real collision. One slot per path.
struct PathState {
    vec3 position;  // render space
    vec3 direction; // unit, of travel: the camera ray's, or that which led to this collision
    vec3 radiance;  // gathered so far
    float beta;     // path throughput, > 0; at a collision it includes that collision's albedo
    uint pixel;     // index into the film, or NO_PIXEL
    uint sample_index;
    uint draw;      // random draws consumed; 0 at the camera, whose draw also holds the first free flight
    uint depth;     // scattering events, this one included; 0 at the camera
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
    uint work_count; // pixels in that list: those in which a sample meets the medium
    uint paths;      // finished, including those that never met the medium
    uint real_collisions;
    uint null_collisions;
    uint cells;   // majorant cells left
    uint shadow_rays;
    uint depth_caps;          // paths ended by maxDepth
    uint step_caps;           // flights ended by the step limit
    uint majorant_violations; // density above its majorant
    uint non_finite;          // samples dropped
    uint queue_overflows;     // items dropped; always 0 unless the program is wrong
    uint non_finite_pixel[NON_FINITE_RECORDS];
    uint non_finite_sample[NON_FINITE_RECORDS];
};

SHARED_END
#endif
