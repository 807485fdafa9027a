// Every buffer, declared once.
#ifndef BUFFERS_GLSL
#define BUFFERS_GLSL
#include "lib/specialization.glsl"

layout(scalar, binding = BINDING_FRAME) uniform FrameBlock { FrameParams frame_block; };
// The same number, though nobody but us knows that it is the same for all lanes. Where a branch or the end of a loop hangs on
// numbers of the frame or push constants alone, Mesa's lavapipe compiles the kernel anew for these numbers, with every submit.
uint by_lane(uint number) {
    return number + (gl_GlobalInvocationID.x >> 31u); // no dispatch has so many
}
float by_lane(float number) {
    return uintBitsToFloat(by_lane(floatBitsToUint(number)));
}

// A copy, read once before any branch or loop: within one, llvmpipe gathers even constants lane by lane, and a quarter of
// all time went by at it. Tables within, looked up by index, are read from the block all the same.
FrameParams read_frame() {
    FrameParams copy = frame_block;
    copy.sensors[0].blades = by_lane(copy.sensors[0].blades);
    copy.media[0].bvh_nodes = by_lane(copy.media[0].bvh_nodes);
    copy.media[0].noise.octaves = by_lane(copy.media[0].noise.octaves);
    copy.sky_count = by_lane(copy.sky_count);
    copy.lamp_first = by_lane(copy.lamp_first);
    copy.lamp_count = by_lane(copy.lamp_count);
    copy.surface_nodes = by_lane(copy.surface_nodes);
    copy.planes = by_lane(copy.planes);
    copy.layers.count = by_lane(copy.layers.count);
    copy.march.jitter = by_lane(copy.march.jitter);
    copy.particles.radius = by_lane(copy.particles.radius);
    copy.particles.unit = by_lane(copy.particles.unit);
    copy.lights[FRAME_BACKGROUND].radiance.x = by_lane(copy.lights[FRAME_BACKGROUND].radiance.x);
    return copy;
}
FrameParams frame = read_frame();
layout(scalar, binding = BINDING_GRID) readonly buffer GridBlock { uint grid_words[]; };
layout(scalar, binding = BINDING_LEAF_TABLE) readonly buffer LeafTableBlock { uint leaf_table[]; };
layout(scalar, binding = BINDING_MAJORANTS) readonly buffer MajorantBlock { float majorants[]; };
layout(scalar, binding = BINDING_CONTROLS) readonly buffer ControlBlock { ControlCell controls[]; };
layout(scalar, binding = BINDING_TRIANGLES) readonly buffer TriangleBlock { vec3 triangles[]; };
layout(scalar, binding = BINDING_BVH) readonly buffer BvhBlock { BvhNode bvh[]; };
layout(scalar, binding = BINDING_PATHS) buffer PathBlock { uint path_words[]; };
layout(scalar, binding = BINDING_QUEUE_ITEMS) buffer QueueItemBlock { uint queue_items[]; };
layout(scalar, binding = BINDING_QUEUES) buffer QueueBlock { QueueHeader queues[]; };
layout(scalar, binding = BINDING_FILM) buffer FilmBlock { FilmPixel film[]; };
layout(scalar, binding = BINDING_WORK) buffer WorkBlock { uint work[]; };
layout(scalar, binding = BINDING_SAMPLES) buffer SampleBlock { uvec3 waiting_samples[]; };
layout(scalar, binding = BINDING_PLACES) buffer PlaceBlock { SamplePlace sample_places[]; };
layout(scalar, binding = BINDING_BLACKBODY) readonly buffer BlackbodyBlock { vec4 blackbody[]; };
layout(binding = BINDING_BLACKBODY_TEXELS) uniform utextureBuffer blackbody_texels;
layout(scalar, binding = BINDING_PHASE) readonly buffer PhaseBlock { PhaseNode phase_nodes[]; };
layout(scalar, binding = BINDING_MAPS) readonly buffer MapBlock { MapKnot map_knots[]; };
layout(scalar, binding = BINDING_LIGHTS) readonly buffer LightBlock { LightRow lights[]; };
layout(scalar, binding = BINDING_SKY) readonly buffer SkyBlock { vec4 sky_storage[]; };
layout(binding = BINDING_SKY_TEXELS) uniform utextureBuffer sky_texels;
layout(scalar, binding = BINDING_SKY_ALIAS) readonly buffer SkyAliasBlock { AliasEntry sky_alias[]; };
layout(binding = BINDING_SKY_ALIAS_TEXELS) uniform utextureBuffer sky_alias_texels;
layout(scalar, binding = BINDING_SURFACES) readonly buffer SurfaceBlock { SurfaceRow surfaces[]; };
layout(scalar, binding = BINDING_PRIMITIVES) readonly buffer PrimitiveBlock { SurfacePrimitive primitives[]; };
#ifdef SURFACES
layout(binding = BINDING_NODE_TEXELS) uniform utextureBuffer node_texels;
layout(binding = BINDING_PRIMITIVE_TEXELS) uniform utextureBuffer primitive_texels;
layout(binding = BINDING_SURFACE_TEXELS) uniform utextureBuffer surface_texels;
#endif
#ifdef RAY_QUERY
layout(binding = BINDING_BOXES) uniform accelerationStructureEXT boxes_of_pieces;
#endif
layout(binding = BINDING_LIGHT_TEXELS) uniform utextureBuffer light_texels;
layout(scalar, binding = BINDING_LIGHT_TREE) readonly buffer LightTreeBlock { LightNode light_nodes[]; };
#ifdef SEVERAL
layout(scalar, binding = BINDING_MEDIA) readonly buffer MediumBlock { MediumParams media[]; };
layout(scalar, binding = BINDING_OVERLAPS) readonly buffer OverlapBlock { uint overlaps[]; };
layout(binding = BINDING_OVERLAP_TEXELS) uniform utextureBuffer overlap_texels;
layout(binding = BINDING_MEMBER_TEXELS) uniform utextureBuffer member_texels;
#endif
layout(scalar, binding = BINDING_POINTS) readonly buffer PointBlock { vec3 sensor_points[]; };
layout(scalar, binding = BINDING_LAYERS) buffer LayerBlock { vec3 layers[]; };
layout(scalar, binding = BINDING_SPLATS) buffer SplatBlock { uint splats[]; };
layout(scalar, binding = BINDING_EMITTERS) readonly buffer EmitterBlock { EmitterRow emitters[]; };
layout(scalar, binding = BINDING_TRACE) buffer TraceBlock {
    uint trace_count;
    TraceRecord trace_records[];
};
layout(scalar, binding = BINDING_LATTICE) buffer LatticeBlock { vec4 lattice[]; };
layout(binding = BINDING_GRID_TEXELS) uniform utextureBuffer grid_texels;
layout(binding = BINDING_LEAF_TEXELS) uniform utextureBuffer leaf_texels;
layout(binding = BINDING_MAJORANT_TEXELS) uniform textureBuffer majorant_texels;
layout(binding = BINDING_LATTICE_TEXELS) uniform textureBuffer lattice_texels;
layout(scalar, binding = BINDING_COUNTERS) buffer CounterBlock { Counters counters; };
layout(scalar, binding = BINDING_COUNTERS) buffer CounterWordBlock { uint counter_words[]; }; // the same

vec4 sky_texel(uint i) {
    return TABLE_TEXELS != 0 ? uintBitsToFloat(texelFetch(sky_texels, int(i))) : sky_storage[i];
}

AliasEntry sky_alias_entry(uint i) {
    if (TABLE_TEXELS == 0)
        return sky_alias[i];
    uvec2 entry = texelFetch(sky_alias_texels, int(i)).xy;
    return AliasEntry(entry.x, entry.y);
}

#endif
