// Maps of the sky whose columns are longitudes and whose rows are latitudes, the zenith above the first row.
#ifndef EQUIRECTANGULAR_GLSL
#define EQUIRECTANGULAR_GLSL
#include "lib/buffers.glsl"
#include "lib/directions.glsl"

// Column and row, in texels from the map's top left corner. The latitude by atan, since near the poles the cosine says little.
vec2 equirectangular_place(vec3 direction) {
    SkyParams sky = frame.sky;
    float longitude = fract(longitude_of(direction) * (0.5 / PI) + 0.5 + sky.turn);
    float latitude = atan(length(direction.xz), direction.y) / PI; // from the zenith
    return vec2(longitude * float(sky.width), latitude * float(sky.height));
}

// `sine`: of the angle to the zenith, by which an interval of longitude is narrower than at the horizon.
vec3 equirectangular_direction(vec2 place, out float sine) {
    SkyParams sky = frame.sky;
    float longitude = (fract(place.x / float(sky.width) - sky.turn) - 0.5) * (2.0 * PI);
    float latitude = place.y * (PI / float(sky.height));
    sine = sin(latitude);
    return normalize(vec3(sine * sin(longitude), cos(latitude), -sine * cos(longitude)));
}

// Of one next to the map at most. Around the horizon, and no further than the poles: beyond the outermost rows' middles their
// values hold.
ivec2 equirectangular_texel(ivec2 texel) {
    ivec2 size = ivec2(frame.sky.width, frame.sky.height);
    int around = texel.x < 0 ? size.x : texel.x < size.x ? 0 : -size.x; // a remainder is dear
    return ivec2(texel.x + around, clamp(texel.y, 0, size.y - 1));
}

#endif
