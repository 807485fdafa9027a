// A path is over: its radiance is a sample of its pixel, and the next sample's turn.
#ifndef STAGE_ACCUMULATE_GLSL
#define STAGE_ACCUMULATE_GLSL
#include "film/aovs.glsl"
#include "film/splats.glsl"
#include "lib/path_words.glsl"
#include "lib/trace.glsl"
#include "sensors/camera.glsl"

void accumulate(inout FilmPixel sums, inout Lane lane, inout Tally tally) {
    trace(TRACE_END, lane, lane.path.position, lane.path.direction);
    uint before = sums.count;
    film_or_splats(sums, measured(lane.path.radiance), PATH_WORD(lane.record, PATH_PIXEL), lane.path.place, lane.path.sample_index, tally);
    if (HAS_LAYERS)
        if (sums.count != before)
            add_layers(lane.record, PATH_WORD(lane.record, PATH_PIXEL));
    lane.path.sample_index += 1u;
    lane.todo = lane.path.sample_index < push.sample_end ? TODO_BEGIN : TODO_DONE;
}

#endif
