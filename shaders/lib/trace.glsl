// Following one path: what befalls it is recorded, in order, since one lane has it at a time. Absent from kernels that follow
// none.
#ifndef TRACE_GLSL
#define TRACE_GLSL
#include "stages/lane.glsl"

void trace(uint kind, Lane lane, vec3 position, vec3 direction) {
    if (TRACE != 0) {
        uint i = trace_count++;
        if (i < TRACE_RECORDS)
            trace_records[i] = TraceRecord(kind, lane.path.depth, lane.steps, position, direction, vec3(lane.beta),
                                           vec3(lane.T), lane.path.radiance);
    }
}

#endif
