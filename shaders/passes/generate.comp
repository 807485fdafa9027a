// Give each free slot its next camera path: the next sample of its pixel, or the first of the next pixel on the work
// list. Samples that miss the medium, at the edge of its silhouette, end here.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../include/pass.glsl"

#include "../include/camera.glsl"
#include "../include/film.glsl"
#include "../include/queue.glsl"
#include "../include/interval.glsl"

// The next pixel of the work list, or NO_PIXEL.
uint take_pixel() {
    if (push.stop != 0u)
        return NO_PIXEL;
    uint index = atomicAdd(counters.next_work, 1u);
    return index < counters.work_count ? work[index] : NO_PIXEL;
}

void begin_path(uint slot, uint pixel, uint sample_index, CameraRay ray) {
    PathState path;
    path.position = ray.origin;
    path.direction = ray.direction;
    path.radiance = vec3(0.0);
    path.pixel = pixel;
    path.sample_index = sample_index;
    path.draw = 0u;
    path.depth = 0u;
    path.suspended = 0u;
    paths[slot] = path;
}

void main() {
    uint slot;
    if (!pop_item(QUEUE_GENERATE, slot))
        return;
    uint pixel = paths[slot].pixel;
    uint sample_index = paths[slot].sample_index + 1u;
    if (pixel == NO_PIXEL || sample_index >= push.sample_end) {
        pixel = take_pixel();
        sample_index = push.sample_begin;
    }
    if (pixel == NO_PIXEL)
        return; // no work left: the slot rests until the next batch
    CameraRay ray = camera_ray(pixel, sample_index);
    vec2 t;
    bool hit = next_interval(frame.volume, to_medium(frame.volume, ray.origin, ray.direction), 0.0, t);
    begin_path(slot, pixel, sample_index, ray);
    if (!hit)
        paths[slot].radiance = frame.background;
    push_item(hit ? QUEUE_TRACK : QUEUE_ACCUMULATE, slot);
}
