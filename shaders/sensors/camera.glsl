// Pinhole camera.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL
#include "lib/rng.glsl"

// Of a film entry, in the picture: x | y << 16. It is the key of the pixel's random numbers, the same whatever the crop.
// The division costs software drivers as much as a step of a walk: once per path is enough.
uint place_of(uint pixel) {
    uint x = frame.crop_x + pixel % frame.crop_width;
    uint y = frame.crop_y + pixel / frame.crop_width;
    return x | y << 16u;
}

Rng pixel_rng(uint place, uint sample_index, uint draw) {
    return Rng(place, sample_index, draw, frame.seed);
}

struct CameraRay {
    vec3 origin; // render space
    vec3 direction;
};

// The ray through a uniformly random point of the pixel (box filter).
CameraRay camera_ray(uint place, uint sample_index) {
    Rng rng = pixel_rng(place, sample_index, 0u);
    vec2 corner = vec2(place & 0xffffu, place >> 16u);
    vec2 p = corner + to_uniform(next_words(rng)).xy;
    SensorParams camera = frame.sensors[0];
    vec3 aside = p.x * camera.right + p.y * camera.down;
    return CameraRay(camera.position + camera.start * aside,
                     normalize(camera.corner + p.x * camera.right + p.y * camera.down));
}

#endif
