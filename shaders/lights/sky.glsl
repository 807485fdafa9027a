// The sky as a map of radiance, interpolated linearly between the middles of texels, over the map's edges too.
//
// A direction is drawn by texel, in proportion to the light that comes through it, and evenly over the map within it.
// So the light over the density is bounded, also where the map is narrow, as at poles: the radiance that the choice of a texel goes
// by is the mean over it as interpolated, into which its neighbours reach.
#ifndef SKY_GLSL
#define SKY_GLSL
#include "lib/alias.glsl"
#include "lib/buffers.glsl"
#include "lib/rng.glsl"
#include "lights/equal_area.glsl"
#include "lights/equirectangular.glsl"
#include "lights/sample.glsl"

// Column and row, in texels from the map's top left corner.
vec2 sky_place(vec3 direction) {
    vec2 place;
    if (EQUAL_AREA)
        place = equal_area_place(direction);
    else
        place = equirectangular_place(direction);
    return place;
}

// `breadth`: of a texel there, by that where texels take most.
vec3 sky_direction(vec2 place, out float breadth) {
    vec3 direction;
    breadth = 1.0;
    if (EQUAL_AREA)
        direction = equal_area_direction(place);
    else
        direction = equirectangular_direction(place, breadth);
    return direction;
}

// What the map has at a place. `pdf`: with which directions in its texel are drawn, per steradian; of sky_value, as if the texel
// took as much of all directions as any does, as equirectangular ones do at the horizon.
struct SkyValue {
    vec3 radiance;
    float pdf;
};

// A texel's entry, or that of what is next to one over the map's edge.
vec4 sky_entry(ivec2 texel) {
    if (EQUAL_AREA)
        texel = equal_area_texel(texel);
    else
        texel = equirectangular_texel(texel);
    return sky_texel(uint(texel.y) * frame.sky.width + uint(texel.x));
}

// `texel`: that the place lies in, which is one of the four that are interpolated.
SkyValue sky_value(vec2 place, uvec2 texel) {
    vec2 corner = floor(place - 0.5);
    vec2 f = place - 0.5 - corner;
    ivec2 at = ivec2(corner);
    vec4 a = sky_entry(at), b = sky_entry(at + ivec2(1, 0)), c = sky_entry(at + ivec2(0, 1)), d = sky_entry(at + ivec2(1, 1));
    bvec2 beyond = notEqual(ivec2(texel), at);
    float upper = beyond.x ? b.a : a.a, lower = beyond.x ? d.a : c.a;
    return SkyValue(mix(mix(a.rgb, b.rgb, f.x), mix(c.rgb, d.rgb, f.x), f.y), beyond.y ? lower : upper);
}

// At a direction's place.
SkyValue sky_toward(vec3 direction, vec2 place) {
    SkyValue value = sky_value(place, min(uvec2(place), uvec2(frame.sky.width, frame.sky.height) - 1u));
    if (!EQUAL_AREA)
        value.pdf /= max(length(direction.xz), 1.0e-12);
    return value;
}

// `u`: of the place within a texel.
LightSample sample_sky(vec2 u, inout Rng rng) {
    SkyParams sky = frame.sky;
    uvec4 words = next_words(rng);
    uint row = below(sky.height, words.x);
    row = choose(sky_alias_entry(row), row, words.y);
    uint column = below(sky.width, words.z);
    column = choose(sky_alias_entry(sky.height + row * sky.width + column), column, words.w);
    vec2 place = vec2(column, row) + u;
    float breadth;
    vec3 direction = sky_direction(place, breadth);
    SkyValue value = sky_value(place, uvec2(column, row));
    return LightSample(direction, FAR, value.radiance, value.pdf / max(breadth, 1.0e-12));
}

#endif
