// The optical depth from each node of the lattice towards a light, marched through the lattice of densities from cell to
// cell. It need not be exact: estimators that use it correct it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "lights/lattice.glsl"
#include "shapes/shape.glsl"

const float DARK = 20.0; // deeper than this no light is seen, and none is looked for

void main() {
    uint i = push.node_begin + gl_GlobalInvocationID.x;
    LatticeParams l = frame.lattice;
    if (i >= uint(l.dims.x * l.dims.y * l.dims.z))
        return;
    ivec3 node = lattice_node(i);
    MediumParams v = frame.media[0];
    Ray ray = Ray(node_position(node), to_medium(v, vec3(0.0), push.towards).direction);
    vec3 cells = abs(ray.direction) / l.spacing; // per world unit
    float dt = 1.0 / max(cells.x, max(cells.y, cells.z));
    vec3 high = l.low + vec3(l.dims - 1) * l.spacing;
    vec2 t;
    float end = intersect_box(ray, l.low, high, t) ? t.y : 0.0;
    float depth = 0.0;
    for (float from = 0.0; from < end && depth < DARK; from += dt) {
        float step = min(dt, end - from);
        depth += v.sigma_t * step * lattice_value(LATTICE_DENSITY, ray.origin + (from + 0.5 * step) * ray.direction);
    }
    store_node(push.lattice, node, depth);
}
