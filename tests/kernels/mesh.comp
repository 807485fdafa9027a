#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "include/mesh.glsl"
TEST_IO(MeshInput, MeshOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    Ray ray = Ray(inputs[i].origin, inputs[i].direction);
    float t_from = 0.0;
    float total = 0.0;
    uint count = 0u;
    vec2 t;
    while (count < 100u && next_mesh_interval(frame.volume.bvh_nodes, ray, t_from, t)) {
        if (count < MESH_INTERVALS)
            outputs[i].t[count] = t;
        total += t.y - t.x;
        t_from = t.y;
        ++count;
    }
    outputs[i].count = count;
    outputs[i].total = total;
}
