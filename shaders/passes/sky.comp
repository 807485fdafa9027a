// Sort the batch's pixels: one whose every sample misses the medium, or a mesh's box, gets its background here and now, in
// registers; the others are listed as work for paths. So the empty part of a picture costs no path, no queue and no waiting.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "sensors/camera.glsl"
#include "film/film.glsl"
#include "lights/table.glsl"
#include "lib/interval.glsl"

void main() {
    uint pixel = push.pixel_begin + gl_GlobalInvocationID.x;
    if (pixel >= push.pixel_end)
        return;
    FilmPixel entry = film[pixel];
    Tally tally = NOTHING_SEEN;
    uint place = place_of(pixel);
    // Though rays miss the medium, they may meet surfaces, or it elsewhere where a domain repeats, and looks may go through it; and
    // layers are for paths to fill. Particles come from wherever.
    bool hit = READS_FLUX || HAS_LAYERS || HAS_PARTICLES || REPEATS || frame.surface_nodes + frame.planes > 0u;
    for (uint i = push.sample_begin; i < push.sample_end && !hit; ++i) {
        CameraRay ray = camera_ray(place, i);
        hit = may_meet_medium(frame.media[0], to_medium(frame.media[0], ray.origin, ray.direction));
        // As a path would find it, in the same order: it is not for the batch to say which bits a sample has.
        vec3 radiance = vec3(0.0);
        if (SEES_LAMPS) {
            Rng rng = pixel_rng(place, i, 0u);
            uint row;
            radiance = seen_lamp(ray.origin, ray.direction, to_uniform(next_words(rng)).w, row).light;
        }
        vec3 light = frame.lights[FRAME_BACKGROUND].radiance;
        if (SEES_SKY)
            light += light_from_beyond(ray.direction, 0.0);
        radiance += light;
        film_add(entry, radiance, place, i, tally);
    }
    if (hit) {
        work[atomicAdd(counters.work_count, 1u)] = pixel;
    } else {
        film[pixel] = entry;
        add_film_tally(tally);
    }
}
