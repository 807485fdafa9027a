// Every buffer, declared once.
#ifndef BUFFERS_GLSL
#define BUFFERS_GLSL
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

#include "shared/estimators.h"
#include "shared/items.h"
#include "shared/frame.h"
#ifdef SURFACES // which may have any colours
#define FULL
#define CHROMATIC
#endif
#include "lib/spectrum.glsl"

layout(constant_id = SPEC_SHAPE) const int SHAPE = SHAPE_NONE;
layout(constant_id = SPEC_FIELD) const int FIELD = FIELD_CONSTANT;
layout(constant_id = SPEC_GRID_TYPE) const int GRID_TYPE = GRID_FLOAT;
layout(constant_id = SPEC_FILTER) const int FILTER = FILTER_TRILINEAR;
layout(constant_id = SPEC_SCATTERING) const int SCATTERING = SCATTERING_MULTIPLE;
layout(constant_id = SPEC_NEE) const int NEE = NEE_NONE;
layout(constant_id = SPEC_EMISSION) const int EMISSION = EMISSION_NONE;
layout(constant_id = SPEC_EMISSION_AT) const int EMISSION_AT = EMISSION_AT_COLLISIONS;
layout(constant_id = SPEC_FREE_FLIGHT) const int FREE_FLIGHT = FREE_FLIGHT_DELTA;
layout(constant_id = SPEC_TRANSMITTANCE) const int TRANSMITTANCE = TRANSMITTANCE_RATIO;
layout(constant_id = SPEC_TEMPERATURE_TYPE) const int TEMPERATURE_TYPE = GRID_FLOAT;
layout(constant_id = SPEC_STEPS) const int STEPS = 1;
layout(constant_id = SPEC_TRACE) const int TRACE = 0;
layout(constant_id = SPEC_TEXELS) const int TEXELS = 0;
layout(constant_id = SPEC_TABLE_TEXELS) const int TABLE_TEXELS = 0;
layout(constant_id = SPEC_LEAPS) const int LEAPS = 0;
#if defined(SEVERAL) && !defined(FULL)
#define FULL
#endif
#ifdef SEVERAL
layout(constant_id = SPEC_MEMBER_SHAPE) const int MEMBER_SHAPE = SHAPE_BOX;
layout(constant_id = SPEC_MEMBER_FIELD) const int MEMBER_FIELD = FIELD_CONSTANT;
layout(constant_id = SPEC_MEMBER_GRID) const int MEMBER_GRID = EACH;
layout(constant_id = SPEC_CELL_BITS) const int CELL_BITS = 0;
#else
const int CELL_BITS = 0;
#endif
#ifdef FULL
layout(constant_id = SPEC_PHASE) const int PHASE = PHASE_HENYEY_GREENSTEIN;
layout(constant_id = SPEC_LIGHTS) const int LIGHTS = LIGHTS_TABLE;
layout(constant_id = SPEC_DISTANCE) const int DISTANCE = DISTANCE_FLIGHTS;
layout(constant_id = SPEC_ALBEDO) const int ALBEDO = ALBEDO_CONSTANT;
layout(constant_id = SPEC_ALBEDO_TYPE) const int ALBEDO_TYPE = GRID_FLOAT;
layout(constant_id = SPEC_MAP) const int MAP = MAP_NONE;
layout(constant_id = SPEC_MAP_HALVINGS) const int MAP_HALVINGS = 0;
layout(constant_id = SPEC_UNBOUNDED) const int UNBOUNDED = 0;
const bool HAS_COLORS = true; // in grids
layout(constant_id = SPEC_SENSOR) const int SENSOR = SENSOR_PINHOLE;
layout(constant_id = SPEC_PIXEL_FILTER) const int PIXEL_FILTER = 0;
layout(constant_id = SPEC_LAYERS) const int LAYERS = 0;
layout(constant_id = SPEC_PATHS) const int PATHS = PATHS_CAMERA;
layout(constant_id = SPEC_PERIODIC) const int PERIODIC = 0;
#else
const int PHASE = PHASE_HENYEY_GREENSTEIN;
const int LIGHTS = LIGHTS_SUN;
const int DISTANCE = DISTANCE_FLIGHTS;
const int ALBEDO = ALBEDO_CONSTANT;
const int ALBEDO_TYPE = GRID_FLOAT;
const int MAP = MAP_NONE;
const int MAP_HALVINGS = 0;
const int UNBOUNDED = 0;
const bool HAS_COLORS = false;
const int SENSOR = SENSOR_PINHOLE;
const int PIXEL_FILTER = 0;
const int LAYERS = 0;
const int PATHS = PATHS_CAMERA;
const int PERIODIC = 0;
#endif
layout(constant_id = SPEC_MIS) const int MIS = MIS_BALANCE;
#ifdef SURFACES
layout(constant_id = SPEC_MATERIALS) const int MATERIALS = 1 << MATERIAL_DIFFUSE;
const bool HAS_TEXTURES = (MATERIALS & 1 << TEXTURED) != 0;
const bool HAS_SMOOTH_FACES = (MATERIALS & 1 << SMOOTH_FACES) != 0;
const bool HAS_SURFACES = true;
#else
const bool HAS_SURFACES = false;
#endif

// What a medium is: a constant, unless it is one of several that differ.
#ifdef SEVERAL
#define KIND(CONSTANT, v, kind) (CONSTANT == EACH ? v.kinds.kind : CONSTANT)
const bool SEVERAL_MEDIA = true;
const bool HAS_CELLS = true; // of majorants
const bool LAYERED = false;  // by itself
#else
#define KIND(CONSTANT, v, kind) CONSTANT
const bool SEVERAL_MEDIA = false;
#ifdef FULL
const bool LAYERED = FIELD == FIELD_LAYERS;
#else
const bool LAYERED = false;
#endif
const bool HAS_CELLS = (int(FIELD == FIELD_GRID) | int(LAYERED)) != 0;
#endif

const bool SEES_SKY = (LIGHTS & LIGHTS_SKY) != 0;
const bool EQUAL_AREA = (LIGHTS & LIGHTS_EQUAL_AREA) != 0;
const bool SEES_LAMPS = (LIGHTS & LIGHTS_LAMPS) != 0;
const bool HAS_TREE = (LIGHTS & LIGHTS_TREE) != 0;
const bool SOME_AIMED = (LIGHTS & LIGHTS_AIMED) != 0;
const bool HAS_LAYERS = LAYERS != 0;
const bool HAS_PARTICLES = PATHS != PATHS_CAMERA;
const bool REPEATS = PERIODIC != 0;
const bool READS_FLUX = SENSOR >= SENSOR_IRRADIANCE; // and no radiance: see flux.glsl
// (In bits, for the sake of glslang 12: see LOOKS.)
const bool LOOKS_FROM_SENSOR = (int(READS_FLUX) & int(NEE != NEE_NONE) & int(LIGHTS != LIGHTS_SUN)) != 0;
const bool COUNTS = (int(READS_FLUX) & int(HAS_PARTICLES)) != 0; // particles, where they pass the sensor, or what they leave
const bool COUNTS_PASSING = (int(COUNTS) & int(SENSOR == SENSOR_IRRADIANCE)) != 0;
const bool COUNTS_ABSORBED = (int(COUNTS) & int(SENSOR == SENSOR_ABSORPTION)) != 0;
const bool LOOKS_ALONG = DISTANCE == DISTANCE_MIXED;
const int FLIGHT_TRAITS = FREE_FLIGHT_TRAITS(FREE_FLIGHT);
const int SHADOW_TRAITS = TRANSMITTANCE_TRAITS(TRANSMITTANCE);
const bool NULL_FLIGHT = (FLIGHT_TRAITS & TRAIT_NULL) != 0;
const bool NULL_TRANSMITTANCE = (SHADOW_TRAITS & TRAIT_NULL) != 0;
const bool MARCHED_TRANSMITTANCE = (SHADOW_TRAITS & TRAIT_MARCH) != 0;

// Where light scatters at most once a march samples no collision: it goes through and gathers along the ray. (A
// function, with a variable, for the sake of glslang 12: see LOOKS.)
bool goes_through() {
    bool marches = (FLIGHT_TRAITS & TRAIT_MARCH) != 0;
    return (SCATTERING != SCATTERING_MULTIPLE && marches) ||
           (SCATTERING == SCATTERING_NONE && FREE_FLIGHT == FREE_FLIGHT_ANALYTIC);
}

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
    copy.lights[LIGHT_BACKGROUND].radiance.x = by_lane(copy.lights[LIGHT_BACKGROUND].radiance.x);
    return copy;
}
FrameParams frame = read_frame();
layout(scalar, binding = BINDING_GRID) readonly buffer GridBlock { uint grid_words[]; };
layout(scalar, binding = BINDING_LEAF_TABLE) readonly buffer LeafTableBlock { uint leaf_table[]; };
layout(scalar, binding = BINDING_MAJORANTS) readonly buffer MajorantBlock { float majorants[]; };
layout(scalar, binding = BINDING_CONTROLS) readonly buffer ControlBlock { ControlCell controls[]; };
layout(scalar, binding = BINDING_TRIANGLES) readonly buffer TriangleBlock { vec3 triangles[]; };
layout(scalar, binding = BINDING_BVH) readonly buffer BvhBlock { BvhNode bvh[]; };
layout(scalar, binding = BINDING_PATHS) buffer PathBlock { PathState paths[]; };
layout(scalar, binding = BINDING_BETAS) buffer BetaBlock { Spectrum betas[]; };
layout(scalar, binding = BINDING_SUSPENDED) buffer SuspendedBlock { Suspended suspended[]; };
layout(scalar, binding = BINDING_QUEUE_ITEMS) buffer QueueItemBlock { uint queue_items[]; };
layout(scalar, binding = BINDING_QUEUES) buffer QueueBlock { QueueHeader queues[]; };
layout(scalar, binding = BINDING_FILM) buffer FilmBlock { FilmPixel film[]; };
layout(scalar, binding = BINDING_WORK) buffer WorkBlock { uint work[]; };
layout(scalar, binding = BINDING_SAMPLES) buffer SampleBlock { uvec3 waiting_samples[]; };
layout(scalar, binding = BINDING_PLACES) buffer PlaceBlock { SamplePlace sample_places[]; };
layout(scalar, binding = BINDING_BLACKBODY) readonly buffer BlackbodyBlock { vec3 blackbody[]; };
layout(scalar, binding = BINDING_PHASE) readonly buffer PhaseBlock { PhaseNode phase_nodes[]; };
layout(scalar, binding = BINDING_MAPS) readonly buffer MapBlock { MapKnot map_knots[]; };
layout(scalar, binding = BINDING_LIGHTS) readonly buffer LightBlock { LightRow lights[]; };
layout(scalar, binding = BINDING_SKY) readonly buffer SkyBlock { vec4 sky_texels[]; };
layout(scalar, binding = BINDING_SKY_ALIAS) readonly buffer SkyAliasBlock { AliasEntry sky_alias[]; };
layout(scalar, binding = BINDING_SURFACES) readonly buffer SurfaceBlock { SurfaceRow surfaces[]; };
layout(scalar, binding = BINDING_PRIMITIVES) readonly buffer PrimitiveBlock { SurfacePrimitive primitives[]; };
#ifdef SURFACES
layout(binding = BINDING_NODE_TEXELS) uniform utextureBuffer node_texels;
layout(binding = BINDING_PRIMITIVE_TEXELS) uniform utextureBuffer primitive_texels;
layout(binding = BINDING_SURFACE_TEXELS) uniform utextureBuffer surface_texels;
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

#endif
