// Choosing among lights that are somewhere: by the power of each over the square of its distance, roughly, and by where it shines,
// down a binary tree whose nodes bound the lights below them, and their cones (Conty Estevez and Kulla, "Importance Sampling of Many
// Lights with Adaptive Tree Splitting", 2018, without the splitting). Every branch has a chance, so every light has.
#ifndef LIGHT_TREE_GLSL
#define LIGHT_TREE_GLSL
#include "lib/buffers.glsl"
#include "lib/rng.glsl"

// Cosine and sine of the angle a less the angle b, or of none if that is more; angles in [0, pi].
vec2 less_angle(vec2 a, vec2 b) {
    return a.x >= b.x ? vec2(1.0, 0.0) : vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
}
vec2 angle_of(float cosine) {
    return vec2(cosine, sqrt(max(1.0 - cosine * cosine, 0.0)));
}

// How much of it shines toward a point `apart` from its middle, roughly, and 0 only if none does: flat lamps by the cosine, spots evenly
// or not. `half_square`: of half of its box's diagonal.
float aim(LightNode node, vec3 apart, float half_square) {
    float square = dot(apart, apart);
    if (node.spread <= -1.0 || square <= half_square)
        return 1.0;
    vec2 seen = angle_of(clamp(dot(node.axis, apart) * inversesqrt(square), -1.0, 1.0));
    vec2 off = less_angle(less_angle(seen, angle_of(sqrt(1.0 - half_square / square))), angle_of(node.spread));
    float within = (off.x - node.reach) / (1.0 - node.reach);
    return within > 0.0 ? mix(0.1, 1.0, within) : 0.0;
}

// `on_surface`: there it pays to ask where lights shine. In matter most noise is that of distances along flights, which may be lit
// elsewhere than `from`, and looks at what does not shine there are cheap.
//
// Near its middle a node counts as about a third of its reach away: an eighth of the square made the least noise of several,
// see tools/results/README.md.
float importance(LightNode node, vec3 from, bool on_surface) {
    vec3 middle = 0.5 * (node.low + node.high);
    vec3 half_size = 0.5 * (node.high - node.low);
    vec3 apart = middle - from;
    float bright = node.power / max(dot(apart, apart), max(0.125 * dot(half_size, half_size), 1.0e-20));
    return SOME_AIMED && on_surface ? bright * aim(node, -apart, dot(half_size, half_size)) : bright;
}

// The row of a light, and the chance that the tree gave it. Each branching takes a word of its own, so that no chance is
// rounded more at the bottom than at the top.
uint descend(vec3 from, bool on_surface, inout Rng rng, out float chance) {
    uint at = 0u;
    chance = 1.0;
    uvec4 words = uvec4(0u);
    for (uint level = 0u; light_nodes[at].light == NO_LIGHT; ++level) {
        if (level % 4u == 0u)
            words = next_words(rng);
        uint left = at + 1u, right = light_nodes[at].right;
        float a = importance(light_nodes[left], from, on_surface), b = importance(light_nodes[right], from, on_surface);
        // A whole number of 2^-32, so that the chance is the branch's own to the last digit.
        uint share = uint(clamp(a + b > 0.0 ? a / (a + b) : 0.5, 1.0e-6, 1.0 - 1.0e-6) * 4294967296.0);
        bool goes_left = words[level % 4u] < share;
        at = goes_left ? left : right;
        chance *= float(goes_left ? share : 0u - share) * 2.3283064365386963e-10;
    }
    return light_nodes[at].light;
}

#endif
