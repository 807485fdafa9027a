// Pinhole camera.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL
#include "rng.glsl"

// Key of a film entry's random numbers: its place in the picture, the same whatever the crop.
Rng pixel_rng(uint pixel, uint sample_index, uint draw) {
    uint x = frame.crop_x + pixel % frame.crop_width;
    uint y = frame.crop_y + pixel / frame.crop_width;
    return Rng(x | y << 16u, sample_index, draw, frame.seed);
}

struct CameraRay {
    vec3 origin; // render space
    vec3 direction;
};

// The ray through a uniformly random point of the pixel (box filter).
CameraRay camera_ray(uint pixel, uint sample_index) {
    Rng rng = pixel_rng(pixel, sample_index, 0u);
    vec2 corner = vec2(rng.pixel & 0xffffu, rng.pixel >> 16u);
    vec2 p = corner + to_uniform(next_words(rng)).xy;
    CameraParams camera = frame.camera;
    vec3 aside = p.x * camera.right + p.y * camera.down;
    return CameraRay(camera.position + camera.start * aside,
                     normalize(camera.corner + p.x * camera.right + p.y * camera.down));
}

#endif
