// Square maps of the sky, all of whose texels take the same solid angle (Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere
// Using SIMD", Journal of Graphics Tools 13(3), 2008), as pbrt-v4 has them. In the square from -1 to 1 the zenith is the
// middle and the horizon the diamond |u| + |v| = 1; what is below the horizon is folded outwards over the diamond's edges, so
// that the four corners are the nadir. A diamond of "radius" r = |u| + |v| about the middle is the cap of 1 - cos = r^2, and
// along its edges longitude is linear.
#ifndef EQUAL_AREA_GLSL
#define EQUAL_AREA_GLSL
#include "lib/buffers.glsl"
#include "lib/directions.glsl"

const float TURN = 6.283185307179586;

// Over the nearest edge of the diamond, to and fro. Where q is 0 both sides lie on the square's rim, and are one place.
vec2 folded(vec2 q) {
    return vec2(q.x < 0.0 ? -1.0 : 1.0, q.y < 0.0 ? -1.0 : 1.0) * (1.0 - abs(q.yx));
}

// Column and row, in texels from the map's top left corner. At the horizon -z is in the middle of the top edge, +x of the right.
vec2 equal_area_place(vec3 direction) {
    float r = length(direction.xz) * inversesqrt(1.0 + abs(direction.y)); // sqrt(1 - |y|), with all digits near 0
    float turns = fract(longitude_of(direction) / TURN + frame.sky.turn);
    vec2 q = r * (1.0 - abs(4.0 * vec2(fract(turns + 0.25), turns) - 2.0));
    q = direction.y < 0.0 ? folded(q) : q;
    return clamp(0.5 * q + 0.5, 0.0, 1.0) * float(frame.sky.width);
}

vec3 equal_area_direction(vec2 place) {
    vec2 q = 2.0 * place / float(frame.sky.width) - 1.0;
    bool below = abs(q.x) + abs(q.y) > 1.0;
    q = below ? folded(q) : q;
    float r = abs(q.x) + abs(q.y);
    float down = q.y / max(r, 1.0e-30); // along the diamond, from -1 at the top
    float turns = (q.x < 0.0 ? 3.0 - down : 1.0 + down) * 0.25 - frame.sky.turn;
    float longitude = (fract(turns + 0.5) - 0.5) * TURN;
    float cosine = below ? r * r - 1.0 : 1.0 - r * r;
    float sine = r * sqrt(max(2.0 - r * r, 0.0));
    return normalize(vec3(sine * sin(longitude), cosine, -sine * cos(longitude)));
}

// Over an edge is the same edge again, the other way around.
ivec2 equal_area_texel(ivec2 texel) {
    int last = int(frame.sky.width) - 1;
    ivec2 inside = clamp(texel, 0, last);
    texel = texel.x != inside.x ? ivec2(inside.x, last - texel.y) : texel;
    inside = clamp(texel, 0, last);
    return texel.y != inside.y ? ivec2(last - texel.x, inside.y) : texel;
}

#endif
