// The staged schedule: samples are added to the film in their order, whatever the order in which their paths ended. A pixel
// leaves its place to another when it has them all.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "film/aovs.glsl"
#include "film/splats.glsl"
#include "sensors/camera.glsl"

// Those of the pixel at a place that follow on what has been added.
void add_samples(uint place, uint index, SamplePlace at) {
    uint samples = push.sample_end - push.sample_begin;
    uint first = place * samples;
    uint pixel = work[index];
    uint where = place_of(pixel);
    Tally tally = NOTHING_SEEN;
    FilmPixel sums = film[pixel];
    for (bool is_there = true; is_there;) {
        vec3 radiance = uintBitsToFloat(waiting_samples[first + at.added]);
        waiting_samples[first + at.added].x = NO_SAMPLE;
        uint before = sums.count;
        film_or_splats(sums, radiance, pixel, where, push.sample_begin + at.added, tally);
        if (HAS_LAYERS)
            if (sums.count != before)
                add_layers(first + at.added, pixel);
        at.added += 1u;
        is_there = at.added < samples && waiting_samples[first + min(at.added, samples - 1u)].x != NO_SAMPLE;
    }
    film[pixel] = sums;
    if (at.added == samples)
        at = SamplePlace(at.tenants + 1u, 0u);
    sample_places[place] = at;
    add_film_tally(tally);
}

void main() {
    uint place = gl_GlobalInvocationID.x;
    SamplePlace at = sample_places[min(place, push.places - 1u)];
    uint index = at.tenants * push.places + place;
    uint next = min(place, push.places - 1u) * (push.sample_end - push.sample_begin) + at.added;
    // A loop, since software drivers do both sides of an `if`: a group of places without news passes it by.
    for (bool has_news = place < push.places && index < counters.work_count && waiting_samples[next].x != NO_SAMPLE; has_news;
         has_news = false)
        add_samples(place, index, at);
}
