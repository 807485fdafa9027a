// A row of the table of lights.
#ifndef LIGHT_ROW_GLSL
#define LIGHT_ROW_GLSL
#include "lib/buffers.glsl"

uvec4 light_texel(uint i, uint which) {
    return texelFetch(light_texels, int(LIGHT_ROW_TEXELS * i + which));
}

LightRow light_at(uint i) {
    if (TABLE_TEXELS == 0)
        return lights[i];
    uvec4 a = light_texel(i, 0u), b = light_texel(i, 1u), c = light_texel(i, 2u), d = light_texel(i, 3u),
          e = light_texel(i, 4u), f = light_texel(i, 5u), g = light_texel(i, 6u), h = light_texel(i, 7u);
    LightRow row;
    row.kind = a.x;
    row.alias = AliasEntry(a.y, a.z);
    row.chance = uintBitsToFloat(a.w);
    row.position = uintBitsToFloat(b.xyz);
    row.extent = uintBitsToFloat(b.w);
    row.direction = uintBitsToFloat(c.xyz);
    row.darkening = uintBitsToFloat(c.w);
    row.edge_u = uintBitsToFloat(d.xyz);
    row.area = uintBitsToFloat(d.w);
    row.edge_v = uintBitsToFloat(e.xyz);
    row.group = e.w;
    row.radiance = uintBitsToFloat(f.xyz);
    row.body = f.w;
    row.full_within = uintBitsToFloat(g.x);
    row.none_beyond = uintBitsToFloat(g.y);
    row.apart = uintBitsToFloat(g.z);
    row.look_density = uintBitsToFloat(g.w);
    row.first_piece = h.x;
    row.pieces = h.y;
    row.sides = h.z;
    return row;
}

#endif
