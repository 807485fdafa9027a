#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "shapes/mesh.glsl"
TEST_IO(MeshInput, MeshOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    Ray ray = Ray(inputs[i].origin, inputs[i].direction);
    MeshRay mesh_ray = make_mesh_ray(0u, frame.media[0].bvh_nodes, ray);
    PartSearch search = begin_search(SEARCH_FIRST, 0.0);
    float total = 0.0;
    uint count = 0u;
    vec2 t = vec2(0.0, 1.0);
    while (count < 100u && t.x < t.y) {
        if (!step_search(frame.media[0].bvh_nodes, mesh_ray, search, t)) {
            t = vec2(0.0, 1.0);
        } else if (t.x < t.y) {
            if (count < MESH_INTERVALS)
                outputs[i].t[count] = t;
            total += t.y - t.x;
            search = begin_search(SEARCH_NEXT, t.y);
            ++count;
        }
    }
    outputs[i].count = count;
    outputs[i].total = total;
}
