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
    uint place = place_of(pixel);
    CameraRay ray = camera_ray(place, sample_index);
    vec2 t;
    bool hit = next_interval(frame.volume, to_medium(frame.volume, ray.origin, ray.direction), 0.0, t);
    paths[slot].pixel = pixel;
    paths[slot].place = place;
    paths[slot].sample_index = sample_index;
    if (!hit)
        paths[slot].radiance = frame.background;
    push_item(hit ? QUEUE_TRACK : QUEUE_ACCUMULATE, slot);
}
