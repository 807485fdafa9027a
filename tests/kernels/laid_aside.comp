// Lays a path aside of which every field is another number, takes it up, and writes out what it was and what it is now, row by
// row. Inputs: what each does next, then whether they may be amid a segment.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
TEST_IO(uint, uint)
#include "stages/laid_aside.glsl"

uint count = 0u;

void fill(out uint word) {
    count += 1u;
    word = 0x40000000u + gl_GlobalInvocationID.x * 4096u + count;
}
void fill(out int i) {
    uint word;
    fill(word);
    i = int(word);
}
void fill(out float x) {
    uint word;
    fill(word);
    x = uintBitsToFloat(word);
}
void fill(out vec2 v) {
    fill(v.x);
    fill(v.y);
}
void fill(out vec3 v) {
    fill(v.x);
    fill(v.y);
    fill(v.z);
}
void fill(out ivec3 v) {
    fill(v.x);
    fill(v.y);
    fill(v.z);
}
#define FILL(type, name) fill(it.name);
#define FILL_WHEN(type, name, when) fill(it.name);
void fill(out PathState it) { VERTEX_STATE(FILL) }
void fill(out Walk it) { WALK_STATE(FILL_WHEN) }
void fill(out PartSearch it) { SEARCH_STATE(FILL) }
void fill(out SurfaceSearch it) { SEEK_STATE(FILL) }
void fill(out Split it) { SPLIT_STATE(FILL) }

// What was and what is, of what rows ask for.
uint written = 0u;
void compare(uint was, uint is) {
    outputs[2u * (gl_GlobalInvocationID.x * push.budget + written)] = was;
    outputs[2u * (gl_GlobalInvocationID.x * push.budget + written) + 1u] = is;
    written += 1u;
}
void compare(int was, int is) {
    compare(uint(was), uint(is));
}
void compare(float was, float is) {
    compare(floatBitsToUint(was), floatBitsToUint(is));
}
void compare(vec2 was, vec2 is) {
    compare(was.x, is.x);
    compare(was.y, is.y);
}
void compare(vec3 was, vec3 is) {
    compare(was.x, is.x);
    compare(was.y, is.y);
    compare(was.z, is.z);
}
void compare(ivec3 was, ivec3 is) {
    compare(was.x, is.x);
    compare(was.y, is.y);
    compare(was.z, is.z);
}
#define COMPARE(type, name) compare(was.name, is.name);
#define COMPARE_WHEN(type, name, when)                                                                                \
    if (when)                                                                                                         \
        compare(was.name, is.name);
#define COMPARE_OR_CLEARED(type, name, when) compare((when) ? was.name : type(0), is.name);
void compare(PathState was, PathState is) { VERTEX_STATE(COMPARE) }
void compare(Walk was, Walk is) {
    WALK_CONDITIONS
    WALK_STATE(COMPARE_OR_CLEARED)
}
void compare(PartSearch was, PartSearch is) { SEARCH_STATE(COMPARE) }
void compare(SurfaceSearch was, SurfaceSearch is) { SEEK_STATE(COMPARE) }
void compare(Split was, Split is) { SPLIT_STATE(COMPARE) }

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= push.lanes)
        return;
    STATE_CONDITIONS
    uint todo = inputs[slot];
    bool amid = inputs[push.lanes] != 0u;
    Lane it;
    fill(it.path);
    PATH_STATE(FILL_WHEN)
    LOOK_STATE(FILL_WHEN)
    SEGMENT_STATE(FILL_WHEN)
    it.todo = todo;
    it.path.todo = todo;
    Rng rng = pixel_rng(it.path.place, it.path.sample_index, it.path.draw);
    Lane was = it, is;
    if (amid)
        lay_aside(slot, it.path.pixel, rng, it, true);
    else
        lay_aside(slot, it.path.pixel, rng, it, false);
    Rng rng_after;
    if (amid)
        take_up(slot, is, rng_after, true);
    else
        take_up(slot, is, rng_after, false);
    compare(was.path, is.path);
    compare(rng.draw, rng_after.draw);
    PATH_STATE(COMPARE_WHEN)
    uint rows = rows_of(todo, amid);
    if (rows >= LOOK_ROWS) {
        LOOK_STATE(COMPARE_WHEN)
    }
    if (rows == SEGMENT_ROWS) {
        SEGMENT_STATE(COMPARE_WHEN)
    }
}
