// The sky as a map of radiance: columns are longitudes, rows latitudes, the zenith above the first row. Radiance is
// interpolated linearly between the middles of texels, around the whole horizon and up to the poles, where the outermost
// rows' values hold.
//
// A direction is drawn by texel, in proportion to the light that comes through it, and evenly in longitude and latitude within it.
// So the light over the density is bounded, at the poles too: the radiance that the choice of a texel goes by is the mean over
// it as interpolated, into which its neighbours reach.
#ifndef SKY_GLSL
#define SKY_GLSL
#include "lib/alias.glsl"
#include "lib/buffers.glsl"
#include "lib/rng.glsl"
#include "lights/sample.glsl"

const float PI = 3.14159265358979;

// Column and row, in texels from the map's top left corner. The latitude by atan, since near the poles the cosine says little.
vec2 sky_place(vec3 direction) {
    SkyParams sky = frame.sky;
    float longitude = fract(atan(direction.x, -direction.z) * (0.5 / PI) + 0.5 + sky.turn);
    float latitude = atan(length(direction.xz), direction.y) / PI; // from the zenith
    return vec2(longitude * float(sky.width), latitude * float(sky.height));
}

vec4 sky_entry(uint column, uint row) {
    return sky_texels[row * frame.sky.width + column];
}

vec3 sky_radiance(vec2 place) {
    SkyParams sky = frame.sky;
    vec2 corner = floor(place - 0.5);
    vec2 f = place - 0.5 - corner;
    uint left = uint(int(corner.x) + int(sky.width)) % sky.width;
    uint right = (left + 1u) % sky.width;
    uint top = uint(max(corner.y, 0.0));
    uint bottom = min(uint(max(corner.y + 1.0, 0.0)), sky.height - 1u);
    return mix(mix(sky_entry(left, top).rgb, sky_entry(right, top).rgb, f.x),
               mix(sky_entry(left, bottom).rgb, sky_entry(right, bottom).rgb, f.x), f.y);
}

// Per steradian. A texel's entry has it for the horizon; elsewhere an interval of latitude and longitude is a smaller angle.
float sky_pdf(vec2 place, vec3 direction) {
    uvec2 texel = min(uvec2(place), uvec2(frame.sky.width, frame.sky.height) - 1u);
    return sky_entry(texel.x, texel.y).a / max(length(direction.xz), 1.0e-12);
}

// `u`: of the place within a texel.
LightSample sample_sky(vec2 u, inout Rng rng) {
    SkyParams sky = frame.sky;
    uvec4 words = next_words(rng);
    uint row = below(sky.height, words.x);
    row = choose(sky_alias[row], row, words.y);
    uint column = below(sky.width, words.z);
    column = choose(sky_alias[sky.height + row * sky.width + column], column, words.w);
    vec2 place = vec2(column, row) + u;
    float longitude = (fract(place.x / float(sky.width) - sky.turn) - 0.5) * (2.0 * PI);
    float latitude = place.y * (PI / float(sky.height));
    float sine = sin(latitude);
    vec3 direction = normalize(vec3(sine * sin(longitude), cos(latitude), -sine * cos(longitude)));
    return LightSample(direction, FAR, sky_radiance(place), sky_entry(column, row).a / max(sine, 1.0e-12));
}

#endif
