// Choosing among lights that are somewhere: by the power of each over the square of its distance, roughly, down a binary tree whose
// nodes bound the lights below them (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting",
// 2018, without the splitting). Every branch has a chance, so every light has.
#ifndef LIGHT_TREE_GLSL
#define LIGHT_TREE_GLSL
#include "lib/buffers.glsl"
#include "lib/rng.glsl"

// Near its middle a node counts as about a third of its reach away: an eighth of the square made the least noise of several,
// see tools/results/README.md.
float importance(LightNode node, vec3 from) {
    vec3 middle = 0.5 * (node.low + node.high);
    vec3 half_size = 0.5 * (node.high - node.low);
    vec3 apart = middle - from;
    return node.power / max(dot(apart, apart), max(0.125 * dot(half_size, half_size), 1.0e-20));
}

// The row of a light, and the chance that the tree gave it. Each branching takes a word of its own, so that no chance is
// rounded more at the bottom than at the top.
uint descend(vec3 from, inout Rng rng, out float chance) {
    uint at = 0u;
    chance = 1.0;
    uvec4 words = uvec4(0u);
    for (uint level = 0u; light_nodes[at].light == NO_LIGHT; ++level) {
        if (level % 4u == 0u)
            words = next_words(rng);
        uint left = at + 1u, right = light_nodes[at].right;
        float a = importance(light_nodes[left], from), b = importance(light_nodes[right], from);
        // A whole number of 2^-32, so that the chance is the branch's own to the last digit.
        uint share = uint(clamp(a / (a + b), 1.0e-6, 1.0 - 1.0e-6) * 4294967296.0);
        bool goes_left = words[level % 4u] < share;
        at = goes_left ? left : right;
        chance *= float(goes_left ? share : 0u - share) * 2.3283064365386963e-10;
    }
    return light_nodes[at].light;
}

#endif
