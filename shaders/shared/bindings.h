// The numbers on which host and kernels must agree: bindings, group size, specialization constants, queues, choices.
#ifndef SHARED_BINDINGS_H
#define SHARED_BINDINGS_H

// One descriptor set serves every pass and every test kernel.
#define BINDING_FRAME 0       // uniform FrameParams
#define BINDING_GRID 1        // NanoVDB grids one after another, 32-bit words
#define BINDING_LEAF_TABLE 2  // one word per 8^3 block of the grid, see density.glsl
#define BINDING_MAJORANTS 3   // float per majorant cell
#define BINDING_PATHS 4       // PathState per slot
#define BINDING_QUEUE_ITEMS 5 // slot numbers, QUEUE_COUNT arrays of the queue capacity
#define BINDING_QUEUES 6      // QueueHeader per queue
#define BINDING_FILM 7        // FilmPixel per pixel of the crop
#define BINDING_COUNTERS 8    // Counters
#define BINDING_WORK 9        // pixels of the batch that meet the medium
#define BINDING_BLACKBODY 10  // vec3, BLACKBODY_ENTRIES colours evenly spaced in temperature
#define BINDING_TEST_INPUT 11 // test kernels only
#define BINDING_TEST_OUTPUT 12
#define BINDING_COUNT 13

#define WORKGROUP_SIZE 64

// Specialization constants. What a scene lacks is false here and absent from its kernels.
#define SPEC_MEDIUM 0
#define SPEC_GRID_TYPE 1
#define SPEC_FILTER 2
#define SPEC_NEE 3
#define SPEC_EMISSION 4
#define SPEC_FREE_FLIGHT 5
#define SPEC_TRANSMITTANCE 6
#define SPEC_STEPS 7 // tracking steps between two looks at what they led to
#define SPEC_TEMPERATURE_TYPE 8 // GRID_...
#define SPEC_COUNT 9

#define MEDIUM_NONE 0 // background only
#define MEDIUM_SPHERE 1
#define MEDIUM_BOX 2
#define MEDIUM_GRID 3

#define GRID_FLOAT 0
#define GRID_FP4 1
#define GRID_FP8 2
#define GRID_FP16 3
#define GRID_FPN 4

#define FILTER_NEAREST 0
#define FILTER_TRILINEAR 1
#define FILTER_STOCHASTIC 2

#define NEE_NONE 0
#define NEE_COLLISIONS 1 // at real collisions

#define EMISSION_NONE 0
#define EMISSION_CONSTANT 1
#define EMISSION_COLOR 2     // and a colour times temperature
#define EMISSION_BLACKBODY 3 // and a black body's colour at that temperature

#define FREE_FLIGHT_ANALYTIC 0
#define FREE_FLIGHT_DELTA 1

#define TRANSMITTANCE_ANALYTIC 0
#define TRANSMITTANCE_RATIO 1

// A slot is in exactly one queue, or held by a lane.
#define QUEUE_GENERATE 0
#define QUEUE_TRACK 1
#define QUEUE_ACCUMULATE 2
#define QUEUE_COUNT 3

#define BLACKBODY_ENTRIES 4096

#define NO_PIXEL 0xffffffffu

#endif
