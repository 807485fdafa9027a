// Every buffer, declared once.
#ifndef BUFFERS_GLSL
#define BUFFERS_GLSL
#extension GL_EXT_scalar_block_layout : require

#include "../shared/bindings.h"
#include "../shared/items.h"
#include "../shared/scene.h"

layout(constant_id = SPEC_MEDIUM) const int MEDIUM = MEDIUM_NONE;
layout(constant_id = SPEC_GRID_TYPE) const int GRID_TYPE = GRID_FLOAT;
layout(constant_id = SPEC_FILTER) const int FILTER = FILTER_TRILINEAR;
layout(constant_id = SPEC_NEE) const int NEE = NEE_NONE;
layout(constant_id = SPEC_EMISSION) const int EMISSION = EMISSION_NONE;
layout(constant_id = SPEC_FREE_FLIGHT) const int FREE_FLIGHT = FREE_FLIGHT_DELTA;
layout(constant_id = SPEC_TRANSMITTANCE) const int TRANSMITTANCE = TRANSMITTANCE_RATIO;
layout(constant_id = SPEC_TEMPERATURE_TYPE) const int TEMPERATURE_TYPE = GRID_FLOAT;
layout(constant_id = SPEC_STEPS) const int STEPS = 1;

layout(scalar, binding = BINDING_FRAME) uniform FrameBlock { FrameParams frame; };
layout(scalar, binding = BINDING_GRID) readonly buffer GridBlock { uint grid_words[]; };
layout(scalar, binding = BINDING_LEAF_TABLE) readonly buffer LeafTableBlock { uint leaf_table[]; };
layout(scalar, binding = BINDING_MAJORANTS) readonly buffer MajorantBlock { float majorants[]; };
layout(scalar, binding = BINDING_PATHS) buffer PathBlock { PathState paths[]; };
layout(scalar, binding = BINDING_QUEUE_ITEMS) buffer QueueItemBlock { uint queue_items[]; };
layout(scalar, binding = BINDING_QUEUES) buffer QueueBlock { QueueHeader queues[]; };
layout(scalar, binding = BINDING_FILM) buffer FilmBlock { FilmPixel film[]; };
layout(scalar, binding = BINDING_WORK) buffer WorkBlock { uint work[]; };
layout(scalar, binding = BINDING_BLACKBODY) readonly buffer BlackbodyBlock { vec3 blackbody[]; };
layout(scalar, binding = BINDING_COUNTERS) buffer CounterBlock { Counters counters; };

#endif
