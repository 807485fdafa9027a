// A phase function by its values at nodes, linear in the cosine between them: what is drawn is what is evaluated.
#ifndef PHASE_TABLE_GLSL
#define PHASE_TABLE_GLSL
#include "lib/buffers.glsl"
#include "lib/directions.glsl"

// The last node but one at most whose x, or share, is not above `key`. By halves, as often as any table may need: a count that
// lanes agree on.
uint phase_node(PhaseParams p, float key, const bool by_share) {
    uint low = p.first_node, last = low + p.nodes - 1u, high = last;
    for (uint size = p.nodes; size > 1u; size = (size + 1u) / 2u) {
        uint middle = (low + high) / 2u;
        float at = by_share ? phase_nodes[middle].share : phase_nodes[middle].x;
        bool is_above = at > key;
        high = is_above ? middle : high;
        low = is_above ? low : middle;
    }
    return min(low, last - 1u);
}

float table_eval(PhaseParams p, vec3 before, vec3 after) {
    vec3 apart = before - after;
    float x = min(0.5 * dot(apart, apart), 2.0); // 1 - mu
    uint i = phase_node(p, x, false);
    PhaseNode a = phase_nodes[i], b = phase_nodes[i + 1u];
    return mix(a.value, b.value, clamp((x - a.x) / (b.x - a.x), 0.0, 1.0));
}

// Within a segment the share below t beyond its first node is 2 pi (a t + slope t^2 / 2).
vec3 table_sample(PhaseParams p, vec3 before, vec2 u) {
    uint i = phase_node(p, u.x, true);
    PhaseNode a = phase_nodes[i], b = phase_nodes[i + 1u];
    float share = max(u.x - a.share, 0.0) * 2.0 * INV_4PI;
    float slope = (b.value - a.value) / (b.x - a.x);
    float root = sqrt(max(a.value * a.value + 2.0 * slope * share, 0.0));
    float t = 2.0 * share / max(a.value + root, 1.0e-30);
    return turned(before, min(a.x + min(t, b.x - a.x), 2.0), u.y);
}

#endif
