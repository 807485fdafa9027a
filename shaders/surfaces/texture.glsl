// The colours of surfaces by images, which repeat without end.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL
#include "surfaces/surface_point.glsl"

vec3 texel(uint first, ivec2 size, ivec2 at) {
    ivec2 inside = ivec2((at.x + size.x) % size.x, (at.y + size.y) % size.y);
    return sky_texel(first + uint(inside.y * size.x + inside.x)).xyz;
}

// Between the middles of texels linear, or the nearest. `place`: across and upwards from its lower left, whose upper right is (1, 1).
vec3 texture_color(uint texture, vec2 place) {
    vec4 header = sky_texel(texture);
    ivec2 size = ivec2(abs(header.xy));
    vec2 within = fract(place * header.zw);
    vec2 at = vec2(within.x, 1.0 - within.y) * vec2(size) - 0.5;
    ivec2 corner = ivec2(floor(at));
    vec2 share = at - vec2(corner);
    if (header.x < 0.0)
        share = step(0.5, share);
    vec3 above = mix(texel(texture + 1u, size, corner), texel(texture + 1u, size, corner + ivec2(1, 0)), share.x);
    vec3 below = mix(texel(texture + 1u, size, corner + ivec2(0, 1)), texel(texture + 1u, size, corner + ivec2(1, 1)), share.x);
    return mix(above, below, share.y);
}

// What the surface is at a point of it.
SurfaceRow row_at(SurfacePoint at) {
    SurfaceRow row = surface_row(at.row);
    if (HAS_TEXTURES)
        if (row.texture != 0u)
            row.color *= texture_color(row.texture - 1u, at.place);
    return row;
}

#endif
