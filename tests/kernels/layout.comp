// Writes the words of every field of every shared struct, in the order of layout_fields.h. Arrays are read at index 1,
// so that a wrong stride shows too.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
TEST_IO(uint, uint)

uint count = 0u;

void put(uint word) {
    outputs[count] = word;
    count += 1u;
}
void put(int i) {
    put(uint(i));
}
void put(float x) {
    put(floatBitsToUint(x));
}
void put(vec2 v) {
    put(v.x);
    put(v.y);
}
void put(vec3 v) {
    put(v.x);
    put(v.y);
    put(v.z);
}
void put(ivec3 v) {
    put(uint(v.x));
    put(uint(v.y));
    put(uint(v.z));
}
void put(vec4 v) {
    put(v.xyz);
    put(v.w);
}

void put(uvec2 v) {
    put(v.x);
    put(v.y);
}
void put(uvec4 v) {
    put(v.x);
    put(v.y);
    put(v.z);
    put(v.w);
}

#define waiting sample_places[1]
#define control_cell controls[1]
#define light_row lights[1]
#define phase_node phase_nodes[1]
#define map_knot map_knots[1]
#define light_node light_nodes[1]
#define emitter_row emitters[1]
#define bvh_node bvh[1]
#define surface_row surfaces[1]
#define piece primitives[1]
#define header queues[1]
#define entry film[1]
#define PUT(field) put(field);
#define PUT_EACH(field, count) for (int k = 0; k < count; ++k) put(field[k]);

void main() {
    if (gl_GlobalInvocationID.x != 0u)
        return;
#include "layout_fields.h"
}
