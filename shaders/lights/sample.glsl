// What a look toward a light is told by that light.
#ifndef LIGHT_SAMPLE_GLSL
#define LIGHT_SAMPLE_GLSL
#include "lib/directions.glsl"
#include "shapes/shape.glsl"

struct LightSample {
    vec3 direction; // unit, towards the light
    float distance; // world units
    vec3 light;     // radiance that comes from there, if nothing is in between; irradiance where pdf is 0
    float pdf;      // of the direction, per steradian; 0 if no other could have been drawn
};

#endif
