// What kernels are compiled for: constants by which drivers, and specialized() before them, leave out what a scene lacks; and
// what follows from them.
#ifndef SPECIALIZATION_GLSL
#define SPECIALIZATION_GLSL
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#ifdef RAY_QUERY
#extension GL_EXT_ray_query : require
#endif

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
layout(constant_id = SPEC_FIRST_FLIGHT) const int FIRST_FLIGHT = FIRST_FLIGHT_DRAWN;
layout(constant_id = SPEC_FREE_FLIGHT) const int FREE_FLIGHT = FREE_FLIGHT_DELTA;
layout(constant_id = SPEC_TRANSMITTANCE) const int TRANSMITTANCE = TRANSMITTANCE_RATIO;
layout(constant_id = SPEC_TEMPERATURE_TYPE) const int TEMPERATURE_TYPE = GRID_FLOAT;
layout(constant_id = SPEC_STEPS) const int STEPS = 1;
layout(constant_id = SPEC_TRACE) const int TRACE = 0;
layout(constant_id = SPEC_TEXELS) const int TEXELS = 0;
layout(constant_id = SPEC_TABLE_TEXELS) const int TABLE_TEXELS = 0;
layout(constant_id = SPEC_LEAPS) const int LEAPS = 0;
layout(constant_id = SPEC_COPIES) const int COPIES = 0;
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
const int LIGHTS = LIGHTS_LONE;
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
const bool HAS_MODELS = (int(MEMBER_SHAPE == SHAPE_MESH) | int(MEMBER_SHAPE == EACH_OR_MODEL)) != 0; // among others
const bool HAS_CELLS = SHAPE != SHAPE_NONE; // of majorants
const bool LAYERED = false;  // by itself
#else
#define KIND(CONSTANT, v, kind) CONSTANT
const bool SEVERAL_MEDIA = false;
#ifdef FULL
const bool LAYERED = FIELD == FIELD_LAYERS;
#else
const bool LAYERED = false;
#endif
const bool HAS_CELLS = (int(SHAPE != SHAPE_NONE) & (int(FIELD == FIELD_GRID) | int(LAYERED))) != 0;
#endif

const bool SEES_SKY = (LIGHTS & LIGHTS_SKY) != 0;
const bool HAS_SKY_MAP = (LIGHTS & LIGHTS_MAP) != 0;
const bool SOLE_LIGHT = (LIGHTS & LIGHTS_SOLE) != 0;
const bool EQUAL_AREA = (LIGHTS & LIGHTS_EQUAL_AREA) != 0;
const bool SEES_LAMPS = (LIGHTS & LIGHTS_LAMPS) != 0;
const bool SEES_SURFACES = (LIGHTS & LIGHTS_SURFACES) != 0;
const bool SEES_GLOW = (LIGHTS & LIGHTS_GLOW) != 0;
const bool MEETS_LIGHTS = (LIGHTS & (LIGHTS_SKY | LIGHTS_SURFACES | LIGHTS_GLOW)) != 0; // that looks find, too
const bool HAS_TREE = (LIGHTS & LIGHTS_TREE) != 0;
const bool SOME_AIMED = (LIGHTS & LIGHTS_AIMED) != 0;
const bool HAS_LAYERS = LAYERS != 0;
const bool HAS_PARTICLES = PATHS != PATHS_CAMERA;
const bool REPEATS = PERIODIC != 0;
// And no radiance: see flux.glsl. (In bits, for the sake of glslang 12: see SHADOW_RAYS_WALK.)
const bool READS_FLUX = (int(SENSOR == SENSOR_IRRADIANCE) | int(SENSOR == SENSOR_FLUENCE) | int(SENSOR == SENSOR_ABSORPTION)) != 0;
const bool LOOKS_FROM_SENSOR = (int(READS_FLUX) & int(NEE != NEE_NONE) & int(LIGHTS != LIGHTS_LONE)) != 0;
const bool COUNTS = (int(READS_FLUX) & int(HAS_PARTICLES)) != 0; // particles, where they pass the sensor, or what they leave
const bool COUNTS_PASSING = (int(COUNTS) & int(SENSOR == SENSOR_IRRADIANCE)) != 0;
const bool COUNTS_ABSORBED = (int(COUNTS) & int(SENSOR == SENSOR_ABSORPTION)) != 0;
const bool LOOKS_ALONG = DISTANCE == DISTANCE_MIXED;
const bool SPLITS = FIRST_FLIGHT == FIRST_FLIGHT_SPLIT;
const int FLIGHT_TRAITS = FREE_FLIGHT_TRAITS(FREE_FLIGHT);
const int SHADOW_TRAITS = TRANSMITTANCE_TRAITS(TRANSMITTANCE);
const bool NULL_FLIGHT = (FLIGHT_TRAITS & TRAIT_NULL) != 0;
const bool NULL_TRANSMITTANCE = (SHADOW_TRAITS & TRAIT_NULL) != 0;
const bool MARCHED_TRANSMITTANCE = (SHADOW_TRAITS & TRAIT_MARCH) != 0;
const bool CONTROLLED_FLIGHT = (FLIGHT_TRAITS & TRAIT_CONTROL) != 0;
const bool CONTROLLED_TRANSMITTANCE = (SHADOW_TRAITS & TRAIT_CONTROL) != 0;

// Where light scatters at most once a march samples no collision: it goes through and gathers along the ray. (A
// function, with a variable, for the sake of glslang 12: see SHADOW_RAYS_WALK.)
bool goes_through() {
    bool marches = (FLIGHT_TRAITS & TRAIT_MARCH) != 0;
    return (SCATTERING != SCATTERING_MULTIPLE && marches) ||
           (SCATTERING == SCATTERING_NONE && (FLIGHT_TRAITS & TRAIT_CLOSED) != 0);
}

#endif
