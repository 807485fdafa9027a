// Inputs and outputs of the test kernels.
#ifndef TEST_ITEMS_H
#define TEST_ITEMS_H
#include "shared/items.h"

SHARED_BEGIN

struct RngOutput {
    uvec4 words;
    vec4 u;
    vec3 tap;
    float exponential; // from words.x
    float of_key;      // the same, were the key itself the words
    float event;       // of the words
    float event_of_key;
    uint draw; // the counter afterwards
};

struct DensityInput {
    vec3 p; // index space
    vec3 tap;
};
struct DensityOutput {
    float filtered; // as SPEC_FILTER says
    float voxel;    // at floor(p)
    float nearest;
    float trilinear;
    float stochastic;
};

struct RayInput {
    vec3 origin;
    vec3 direction;
    uint key;     // of the random numbers
    float e;      // unit exponential of the first free flight; of a walk, 0: more than any grid holds
    float select; // of its channel
    vec3 beta;
};
struct WalkStep {
    ivec3 cell; // passed in this step
    float t;    // after it
    float sigma_maj;
    float tau; // left after it
    uint event;
};
struct FlightOutput {
    uint event;
    float t;     // world units from the ray's origin
    vec3 weight; // transmittance, or the throughput after a flight; of a grey medium thrice the same
    uint nulls;
    uint lookups;
    uint steps;
};

struct AheadOutput {
    uint event;
    float t;   // world units from where the ray meets the medium
    vec3 beta; // after a flight
    vec3 T;    // of a shadow ray
    uint draw; // of random numbers, the next
    uint lookups;
    uint cells;
    uint steps;
    uint nulls;
    uint violations;
};

struct PhaseInput {
    float g;
    vec3 direction;
    vec2 u;
};
struct PhaseOutput {
    vec3 direction;
    float from_peak; // as drawn
    float eval;      // hg_eval of it
    float eval_pair; // hg_eval of the directions before and after
    vec3 tangent;
    vec3 bitangent;
};

struct ScatterInput {
    vec3 before;
    vec2 u;
    float x; // 1 - mu
};
struct ScatterOutput {
    vec3 drawn;
    float drawn_eval;
    vec3 at; // of x
    float at_eval;
    float at_eval_twice;
};

struct ShapeInput {
    vec3 origin;
    vec3 direction;
    vec3 low;
    vec3 high;
};
struct ShapeOutput {
    uint box_hit;
    vec2 box;
    uint ball_hit;
    vec2 ball;
};

struct FilmInput {
    FilmPixel pixel;
    vec3 radiance; // added as it is if random is 0
    uint random;   // else as many times a number that differs each time
    uint first;    // key of the first
};

#define MESH_INTERVALS 16

struct MeshInput {
    vec3 origin;
    vec3 direction; // unit
};
struct MeshOutput {
    uint count;             // of intervals, also of those beyond the array's end
    vec2 t[MESH_INTERVALS]; // in order
    float total;            // length of all together
};

struct NoiseInput {
    vec3 position; // render space
};
struct NoiseOutput {
    float density;
    float octave; // the first alone, before clamping
};

struct SkyInput {
    uint key;
    vec3 direction;
};

struct SkyOutput {
    vec3 direction;
    vec3 light; // as drawn
    float pdf;
    vec3 radiance; // looked up in that direction
    float pdf_there;
    vec3 given_radiance; // and in the given one
    float given_pdf;
    vec3 given_again; // the direction of that one's place
};

struct LookInput {
    uint key;
    vec3 position;
    uint on_surface; // 1: it is, 0: it is in matter
    vec3 normal;     // see Lit
};

struct LookOutput {
    uint index;
    float chance;
    vec3 direction;
    float distance;
    vec3 light;
    float pdf;
};

SHARED_END
#endif
