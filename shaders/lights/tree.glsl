// Choosing among lights that are somewhere: by the power of each over the square of its distance, roughly, and by where it shines,
// down a binary tree whose nodes bound the lights below them, and their cones (Conty Estevez and Kulla, "Importance Sampling of Many
// Lights with Adaptive Tree Splitting", 2018, without the splitting). Every light has a chance.
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

// Whom lights are to be chosen for: a point, or a stretch of a ray that begins there.
struct Lit {
    vec3 from;
    bool on_surface; // there it pays to ask where lights shine: in matter most noise is that of distances along flights, which may be
                     // lit elsewhere than `from`, and looks at what does not shine there are cheap
    vec3 normal;     // unit: light counts that comes from this side, by the cosine; 0: from everywhere
    vec3 direction;
    float extent;  // 0 of a point
    float sigma_t; // roughly
};

Lit lit_point(vec3 from, bool on_surface, vec3 normal) {
    return Lit(from, on_surface, normal, vec3(0.0), 0.0, 0.0);
}

// Cosine under which lights in a box stand over a surface, roughly, and 0 only if none does: the height of its middle, or of half its
// top if that is more, over how far off its nearest point is.
float cosine_before(vec3 normal, vec3 apart, vec3 half_size) {
    float middle = dot(normal, apart), top = middle + dot(abs(normal), half_size);
    float height = max(middle, 0.5 * top);
    vec3 nearest = max(abs(apart) - half_size, 0.0);
    return normal == vec3(0.0) ? 1.0 : clamp(height * inversesqrt(max(dot(nearest, nearest), 1.0e-20)), 0.0, 1.0);
}

// Integral of the density by which distances are drawn, see equiangular.glsl, from the foot to x times as far as that is off.
float drawn_before(float x) {
    float part = 1.0 - 1.0 / (1.0 + abs(x));
    return x < 0.0 ? -part : part;
}

// What a ray gathers in matter from a light that it passes: of about the angle under which the light sees it over how far off it is, by
// what is left of the ray there, and of where it begins. `least`: the square of how far off it counts at least.
float gathered(Lit lit, vec3 apart, float half_square, float least) {
    float foot = dot(apart, lit.direction);
    vec3 aside = apart - foot * lit.direction;
    float off = sqrt(max(dot(aside, aside), least));
    float angle = drawn_before((lit.extent - foot) / off) - drawn_before(-foot / off);
    float left = exp(-lit.sigma_t * clamp(foot - sqrt(half_square), 0.0, lit.extent));
    return left * angle / off + min(lit.extent, 1.0 / lit.sigma_t) / max(dot(apart, apart), least);
}

// Near its middle a node counts as about a third of its reach away: an eighth of the square made the least noise of several,
// see tools/results/README.md.
float importance(LightNode node, Lit lit) {
    vec3 middle = 0.5 * (node.low + node.high);
    vec3 half_size = 0.5 * (node.high - node.low);
    vec3 apart = middle - lit.from;
    float half_square = dot(half_size, half_size), least = max(0.125 * half_square, 1.0e-20);
    if (lit.extent > 0.0)
        return node.power_in_matter * gathered(lit, apart, half_square, least);
    float near = 1.0 / max(dot(apart, apart), least);
    if (!lit.on_surface)
        return node.power_in_matter * near;
    return node.power * near * cosine_before(lit.normal, apart, half_size) * (SOME_AIMED ? aim(node, -apart, half_square) : 1.0);
}

// Of the choices this share is made without a look at the lights, by halves: what seems faint here is yet found, and counts no more
// than that many times.
const float EVENLY = 0.02;

// The row of a light, and the chance that the tree gave it. Each branching takes a word of its own, so that no chance is
// rounded more at the bottom than at the top.
uint descend(Lit lit, inout Rng rng, out float chance) {
    uint at = 0u;
    float by_light = 1.0, by_halves = 1.0;
    uvec4 words = uvec4(0u);
    bool evenly = false;
    for (uint level = 0u; light_nodes[at].light == NO_LIGHT; ++level) {
        if (level % 3u == 0u)
            words = next_words(rng);
        evenly = level == 0u ? to_uniform(words).w < EVENLY : evenly;
        uint left = at + 1u, right = light_nodes[at].right;
        float a = importance(light_nodes[left], lit), b = importance(light_nodes[right], lit);
        // A whole number of 2^-32, so that the chance is the branch's own to the last digit.
        uint share = uint(clamp(a + b > 0.0 ? a / (a + b) : 0.5, 1.0e-6, 1.0 - 1.0e-6) * 4294967296.0);
        bool goes_left = words[level % 3u] < (evenly ? 0x80000000u : share);
        at = goes_left ? left : right;
        by_light *= float(goes_left ? share : 0u - share) * 2.3283064365386963e-10;
        by_halves *= 0.5;
    }
    chance = mix(by_light, by_halves, EVENLY);
    return light_nodes[at].light;
}

#endif
