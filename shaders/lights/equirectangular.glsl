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
    vec2 around = on_circle(place.x / float(sky.width) - sky.turn - 0.5);
    float upper = place.y <= 0.5 * float(sky.height) ? 1.0 : -1.0;
    float from_pole = (upper > 0.0 ? place.y : float(sky.height) - place.y) * (PI / float(sky.height));
    sine = sine_of_quarter(from_pole); // of which the density is as good as this
    return normalize(vec3(sine * around.y, upper * sine_of_quarter(0.5 * PI - from_pole), -sine * around.x));
}

// Of one next to the map at most. Around the horizon, and no further than the poles: beyond the outermost rows' middles their
// values hold.
ivec2 equirectangular_texel(ivec2 texel) {
    ivec2 size = ivec2(frame.sky.width, frame.sky.height);
    int around = texel.x < 0 ? size.x : texel.x < size.x ? 0 : -size.x; // a remainder is dear
    return ivec2(texel.x + around, clamp(texel.y, 0, size.y - 1));
}

#endif
