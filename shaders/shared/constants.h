// The numbers on which host and kernels must agree: bindings, group size, specialization constants, queues, choices.
#ifndef SHARED_CONSTANTS_H
#define SHARED_CONSTANTS_H

// One descriptor set serves every pass and every test kernel.
#define BINDING_FRAME 0       // uniform FrameParams
#define BINDING_GRID 1        // NanoVDB grids one after another, 32-bit words, unless they lie in windows
#define BINDING_LEAF_TABLE 2  // one word per 8^3 block of the grid, see density.glsl
#define BINDING_MAJORANTS 3   // float per majorant cell, see empty_space.h
#define BINDING_PATHS 4       // words of the path in each slot, see path_words.glsl
#define BINDING_QUEUE_ITEMS 5 // slot numbers, QUEUE_COUNT arrays of the queue capacity
#define BINDING_QUEUES 6      // QueueHeader per queue
#define BINDING_FILM 7        // FilmPixel per pixel of the crop
#define BINDING_COUNTERS 8    // Counters
#define BINDING_WORK 9        // pixels of the batch that may meet the medium
#define BINDING_BLACKBODY 10  // vec4, BLACKBODY_ENTRIES colours evenly spaced in temperature
#define BINDING_EMITTERS 11   // EmitterRow
#define BINDING_CONTROLS 12   // ControlCell per majorant cell
#define BINDING_TRIANGLES 13  // vec3, three corners per triangle, counterclockwise seen from without; render space
#define BINDING_BVH 14        // BvhNode: of a medium's mesh, then of the surfaces
#define BINDING_SPLATS 15     // words, six per sample of each pixel: see splats.glsl
#define BINDING_TRACE 16      // TraceHeader and TraceRecords, only where one path is followed
#define BINDING_LATTICE 17    // vec4 per node of two lattices, see lattice.glsl
#define BINDING_SAMPLES 18    // staged: vec3 radiance per sample that waits to be added to the film
#define BINDING_PLACES 19     // staged: SamplePlace
#define BINDING_LIGHTS 20     // LightRow, those that are chosen among
#define BINDING_SKY 21        // vec4 per texel of a map of the sky, see sky.glsl, and then of textures, see texture.glsl
#define BINDING_SKY_ALIAS 22  // AliasEntry per row of that map, then per texel
#define BINDING_LIGHT_TREE 23 // LightNode, depth first
#define BINDING_PHASE 24      // PhaseNode, of phase functions that are tables
#define BINDING_SURFACES 25   // SurfaceRow
#define BINDING_PRIMITIVES 26 // SurfacePrimitive
#define BINDING_MAPS 27       // MapKnot, a table for each medium that has a map; see value_map.glsl
#define BINDING_POINTS 28     // vec3 per point of a sensor that reads flux at points, render space
#define BINDING_LAYERS 29     // vec3 per layer of each path, then four of each pixel: see aovs.glsl
// A scene has these or those, since devices may allow no more than thirty: of several media none is a mesh or has a control grid.
#define BINDING_MEDIA BINDING_TRIANGLES  // MediumParams; see superposition.glsl
#define BINDING_OVERLAPS BINDING_CONTROLS // words: what look-ups ask several media for, and which of them are where; see superposition.glsl
// Test kernels only. They use none of the two, and drivers may allow no more buffers than there are.
#define BINDING_TEST_INPUT BINDING_POINTS
#define BINDING_TEST_OUTPUT BINDING_LAYERS
#define BINDING_BUFFERS 30
// The same buffers as texels: software drivers gather these, and read storage buffers lane by lane.
#define BINDING_GRID_TEXELS 30
#define BINDING_LEAF_TEXELS 31
#define BINDING_MAJORANT_TEXELS 32
#define BINDING_LATTICE_TEXELS 33
#define BINDING_OVERLAP_TEXELS 34
#define BINDING_MEMBER_TEXELS 35 // the same, four words at a time
#define BINDING_NODE_TEXELS 36 // of BINDING_BVH, two to a node
#define BINDING_PRIMITIVE_TEXELS 37 // three to a primitive
#define BINDING_SURFACE_TEXELS 38 // SURFACE_ROW_TEXELS to a row
#define BINDING_LIGHT_TEXELS 39 // LIGHT_ROW_TEXELS to a row
#define BINDING_BLACKBODY_TEXELS 40
#define BINDING_SKY_TEXELS 41 // one to a texel of the sky, then of textures
#define BINDING_SKY_ALIAS_TEXELS 42 // one to an entry
#define BINDING_COUNT 43
#define BINDING_BOXES 43 // acceleration structure over boxes of surfaces' pieces, planes not among them; where devices have ray queries

#define WORKGROUP_SIZE 64

// Rows of the tables that a frame has. Of several media it has the superposition, and these are in a table of their own;
// so are of more lights those that are chosen among.
#define MOST_SENSORS 1
#define MOST_MEDIA 1
#define MOST_LIGHTS 2
#define FRAME_BACKGROUND 0
#define FRAME_DIRECTIONAL 1

// Specialization constants. What a scene lacks is false here and absent from its kernels.
#define SPEC_SHAPE 0
#define SPEC_FIELD 1
#define SPEC_GRID_TYPE 2
#define SPEC_FILTER 3
#define SPEC_SCATTERING 4
#define SPEC_NEE 5
#define SPEC_EMISSION 6
#define SPEC_EMISSION_AT 7
#define SPEC_FREE_FLIGHT 8
#define SPEC_TRANSMITTANCE 9
#define SPEC_TEMPERATURE_TYPE 10 // GRID_...
#define SPEC_STEPS 11            // tracking steps in a turn
#define SPEC_WINDOW_BITS 12      // log2 of the words in a window, where grids lie in windows
#define SPEC_TRACE 13            // 1: vertices are recorded, of the one path there is
#define SPEC_TEXELS 14           // 1: grids, their tables and lattices are read as texels
#define SPEC_LEAPS 15            // 1: walks pass empty majorant cells together
#define SPEC_PHASE 16
#define SPEC_LIGHTS 17
#define SPEC_MIS 18
#define SPEC_DISTANCE 19
#define SPEC_ALBEDO 20      // ALBEDO_...
#define SPEC_ALBEDO_TYPE 21 // GRID_...
#define SPEC_SENSOR 22       // SENSOR_...
#define SPEC_PIXEL_FILTER 23 // PIXEL_...
#define SPEC_MEMBER_SHAPE 24 // of several media: SHAPE_...,
#define SPEC_MEMBER_FIELD 25 // FIELD_...
#define SPEC_MEMBER_GRID 26  // 0: all that are grids have the same one
#define SPEC_CELL_BITS 27    // of several media: log2 of the cells along the edge of a coarse one; 0: there are no coarse ones
#define SPEC_MATERIALS 28    // bits, 1 << MATERIAL_..., of those that the surfaces have; SMOOTH_FACES, TEXTURED
#define SPEC_MAP 29          // MAP_...
#define SPEC_MAP_HALVINGS 30 // log2 of the knots in a map's table
#define SPEC_UNBOUNDED 31    // 1: some medium is everywhere
#define SPEC_LAYERS 32       // LAYERS_..., a sum
#define SPEC_TABLE_TEXELS 33 // 1: lights, surfaces, their pieces, the hierarchy of those, black bodies, the sky, its choices and textures are read as texels
#define SPEC_PATHS 34        // PATHS_...
#define SPEC_PERIODIC 35     // 1: a domain repeats
#define SPEC_COPIES 36       // 1: a path's words are copied in loops, see laid_aside.glsl
#define SPEC_FIRST_FLIGHT 37  // FIRST_FLIGHT_...
#define SPEC_COUNT 38

// Value of a constant in which several media differ: each has its own, in its row.
#define EACH -1
#define EACH_OR_MODEL -2 // a shape, and some are meshes

#define SHAPE_NONE 0 // background only
#define SHAPE_SPHERE 1
#define SHAPE_BOX 2 // of a grid too
#define SHAPE_MESH 3

// Words at the head of a mesh among several media, after the lowest corner of its cubes: see host/assets/inside_lattice.h.
#define INSIDE_PER_UNIT 3 // 1 / edge of a cube
#define INSIDE_DIMS 4     // cubes
#define INSIDE_CORNERS 7  // where those of the triangles are
#define INSIDE_REACH 8    // what coordinates differ by, at most
#define INSIDE_HEAD 9

#define FIELD_CONSTANT 0 // density 1
#define FIELD_NOISE 1
#define FIELD_GRID 2
#define FIELD_SUPERPOSITION 3 // of several media: its density is their extinction [1 / world unit]
#define FIELD_LAYERS 4 // by height

#define GRID_FLOAT 0
#define GRID_FP4 1
#define GRID_FP8 2
#define GRID_FP16 3
#define GRID_FPN 4
#define GRID_COLOR 5 // three floats; not of densities

#define SENSOR_PINHOLE 0
#define SENSOR_LENS 1
#define SENSOR_ORTHOGRAPHIC 2
#define SENSOR_EQUIRECTANGULAR 3
#define SENSOR_IRRADIANCE 4 // these three read flux: see flux.glsl
#define SENSOR_FLUENCE 5
#define SENSOR_ABSORPTION 6

// Where samples lie: evenly in their pixel; evenly in a box about its middle; or as the quantiles of a filter have it, between
// 0 and its radius.
#define PIXEL_EVEN 0
#define PIXEL_BOX 1
#define PIXEL_QUANTILES 2
#define FILTER_QUANTILE_BITS 6
#define FILTER_QUANTILES (1 << FILTER_QUANTILE_BITS)

// Images of more than radiance; see aovs.glsl.
#define LAYERS_KINDS 1     // of light: SCATTERED_NEVER and so on
#define LAYERS_GROUPS 2    // by the group of the light that it comes from
#define LAYERS_MEDIA 4     // by the medium that sends it toward the sensor
#define LAYERS_COLLISION 8 // depth and coverage of the first, and its position
#define LAYERS_ALBEDO 16   // there
#define LAYERS_THROUGH 32  // transmittance of the sensor's rays, and its mean over colours
#define LAYERS_NORMAL 128  // of the first surface
#define LAYERS_HOLDOUT 64  // light that was not scattered, and no medium's, stays out of the picture

// Layers by how often light was scattered on its way; of these SCATTERED_KINDS.
#define SCATTERED_NEVER 0 // never: seen straight
#define GLOW_OF_MEDIA 1   // never, and sent out by a medium
#define SCATTERED_ONCE 2
#define SCATTERED_OFTEN 3
#define SCATTERED_KINDS 4

#define ALBEDO_CONSTANT 0
#define ALBEDO_GRID 1

// From values of a grid to densities; see value_map.glsl.
#define MAP_NONE 0
#define MAP_DENSITY 1
#define MAP_ALBEDO 2 // and to albedos,
#define MAP_GLOW 3   // and to emission

#define FILTER_NEAREST 0
#define FILTER_TRILINEAR 1
#define FILTER_STOCHASTIC 2

#define SCATTERING_NONE 0   // absorption and emission only
#define SCATTERING_SINGLE 1 // of the light, once; the background is seen through the medium but not scattered
#define SCATTERING_MULTIPLE 2

#define NEE_NONE 0
#define NEE_COLLISIONS 1 // at real collisions
#define NEE_TENTATIVE 2  // at every tentative collision, weighted by sigma_t / sigma_maj
#define NEE_CACHED 3     // at real collisions, by chance: they correct a cached transmittance

// In which a cache for lights of a table knows optical depths: along the axes, x first, + before -; and between any three of
// them, by signs: bit 0 of x, set for -.
#define CACHE_DIRECTIONS 14
#define CACHE_AXES 6
#define CACHE_SUNS 2 // and at most so many besides, from where much of the light comes

// As numbered in the scene: vkvol::PhaseFunction.
#define PHASE_HENYEY_GREENSTEIN 0
#define PHASE_RAYLEIGH 1
#define PHASE_DOUBLE_HENYEY_GREENSTEIN 2
#define PHASE_DRAINE 3
#define PHASE_DROPLETS 4
#define PHASE_TABLE 5

#define LIGHTS_LONE 0   // one without place or extent, or none, besides an even background
#define LIGHTS_TABLE 1 // any, of which every look chooses one; and sums with
#define LIGHTS_SKY 2   // some that flights meet by themselves when they leave: suns or, with the next, a map too
#define LIGHTS_MAP 64  // a map of the sky
#define LIGHTS_SOLE 128 // no more than one
#define LIGHTS_LAMPS 4 // some that have a shape and a place
#define LIGHTS_TREE 8  // several that have a place
#define LIGHTS_AIMED 32 // of those that have a place, some that do not shine into all directions
#define LIGHTS_SURFACES 256 // surfaces of any shape, which flights meet, too
#define LIGHTS_GLOW 512 // media that glow, which flights meet, too
#define LIGHTS_EQUAL_AREA 16 // a map of the sky, and that a square one; see equal_area.glsl

// Kinds of lights: each a number of its own, and what else is to be known of it.
#define LIGHT_PLACED 16 // is at a place; the others are infinitely far
#define LIGHT_SHAPED 32 // and of some size, which sensors see: a lamp
#define LIGHT_FLAT 64   // which shines by the cosine
#define LIGHT_AIMED 128 // does not shine into all directions
#define LIGHT_DIRECTIONAL 0
#define LIGHT_SUN 1 // in the sky
#define LIGHT_MAP 2 // of the sky
#define LIGHT_POINT (3 | LIGHT_PLACED)
#define LIGHT_SPOT (4 | LIGHT_PLACED | LIGHT_AIMED)
#define LIGHT_SPHERE (5 | LIGHT_PLACED | LIGHT_SHAPED)
#define LIGHT_DISK (6 | LIGHT_PLACED | LIGHT_SHAPED | LIGHT_FLAT | LIGHT_AIMED)
#define LIGHT_RECTANGLE (7 | LIGHT_PLACED | LIGHT_SHAPED | LIGHT_FLAT | LIGHT_AIMED)
#define LIGHT_SURFACE (8 | LIGHT_PLACED) // of any shape, which flights meet, too: no lamp
#define LIGHT_GLOW (9 | LIGHT_PLACED)    // a medium, likewise

// What a surface is made of. A plane has no end; there are few, and no hierarchy holds them.
#define SURFACE_TRIANGLES 0
#define SURFACE_SPHERE 1
#define SURFACE_DISK 2
#define SURFACE_PLANE 3
#define MOST_PLANES 8
#define MOST_FACETS 16 // of one walk among a rough surface's
#define MOST_EVEN_MEDIA 32 // that a shadow ray asks one by one

// How it scatters.
#define MATERIAL_DIFFUSE 0
#define MATERIAL_MIRROR 1
#define MATERIAL_CONDUCTOR 2
#define MATERIAL_DIELECTRIC 3
#define MATERIAL_COATED 4 // diffuse, below a smooth dielectric
#define MATERIAL_ROUGH_CONDUCTOR 5
#define MATERIAL_ROUGH_DIELECTRIC 6
#define MATERIAL_THIN_DIELECTRIC 7 // both sides of a pane at once
// No materials, but further bits of SPEC_MATERIALS.
#define SMOOTH_FACES 16 // some triangles have normals of their own
#define TEXTURED 17     // some surfaces have a texture

// What a piece of surfaces is that rays do not meet.
#define DETAIL_NORMALS 1 // a, b, c: of a triangle's corners; surface: the piece that is their places, or 0
#define DETAIL_PLACES 2  // a.xy, b.xy, c.xy: of its corners on a texture
#define DETAIL_AXES 3    // by which a texture lies on what is no triangle: of a ball x, y, z; else x, y, and from where

// In place of a primitive's number; and a bit that is set where there is one.
#define NO_SURFACE 0xffffffffu
#define AT_SURFACE 0x80000000u

// How what looks toward a light and what flights meet of it share the work.
#define MIS_BALANCE 0
#define MIS_POWER 1
#define MIS_LIGHT 2 // all by looks
#define MIS_PHASE 3 // all by flights; but for lights without extent

// How the distances are found from which light is scattered that comes from near.
#define DISTANCE_FLIGHTS 0 // by free flights alone
#define DISTANCE_MIXED 1   // and by looks from along them; see equiangular.glsl

// What becomes of a path's first flight.
#define FIRST_FLIGHT_DRAWN 0 // as of all others, it collides or it goes through
#define FIRST_FLIGHT_SPLIT 1 // both; see split.glsl

// Where paths begin.
#define PATHS_CAMERA 0
#define PATHS_LIGHT 1 // particles, at lights: each of their vertices looks toward the sensor
#define PATHS_BOTH 2  // one of each kind for a sample
#define SPLAT_WORDS 6 // of a sample of a pixel

// What particles come from: EmitterRow::source is one of these, or a light's row, or AT_SURFACE + a primitive's number.
#define SOURCE_BACKGROUND 0x7fffffffu
#define SOURCE_GLOW 0x7ffffffeu

#define EMISSION_NONE 0
#define EMISSION_CONSTANT 1
#define EMISSION_COLOR 2     // and a colour times temperature
#define EMISSION_BLACKBODY 3 // and a black body's colour at that temperature

#define EMISSION_AT_COLLISIONS 0 // real ones
#define EMISSION_AT_STEPS 1      // integrated along the flight, one sample per step

// What these do is in estimators.h.
#define FREE_FLIGHT_ANALYTIC 0
#define FREE_FLIGHT_REGULAR 1
#define FREE_FLIGHT_MARCH 2
#define FREE_FLIGHT_ADAPTIVE 3
#define FREE_FLIGHT_DELTA 4
#define FREE_FLIGHT_WEIGHTED 5
#define FREE_FLIGHT_DECOMPOSITION 6
#define FREE_FLIGHT_SPECTRAL 7
#define FREE_FLIGHT_COUNT 8

#define TRANSMITTANCE_ANALYTIC 0
#define TRANSMITTANCE_REGULAR 1
#define TRANSMITTANCE_DELTA 2
#define TRANSMITTANCE_RATIO 3
#define TRANSMITTANCE_RESIDUAL 4
#define TRANSMITTANCE_MARCH 5
#define TRANSMITTANCE_TELESCOPING 6
#define TRANSMITTANCE_JACKKNIFE 7
#define TRANSMITTANCE_COUNT 8

#define SEARCH_OVER 0 // the ray is within a part
#define SEARCH_FIRST 1
#define SEARCH_NEXT 2
#define SEARCH_EMPTY 3 // there is no further part

#define MESH_LEAF 4            // triangles in a leaf of a mesh's hierarchy, at most
#define MESH_NODES_PER_TURN 64 // of the hierarchy, which a turn of the track pass visits
#define SURFACE_NODES_PER_TURN 32

// A slot is in one queue, or held by a lane, or at rest when nothing is left to do.
#define QUEUE_GENERATE 0 // free slots
#define QUEUE_RESUME 1   // paths laid aside where a lane's budget was spent, which lanes take first
#define QUEUE_TRACK 2    // fused: pixels of which no sample has begun; staged: flights
#define QUEUE_LOOK 3     // staged: like QUEUE_RESUME, amid shadow rays
#define QUEUE_SHADOW 4   // staged: shadow rays
#define QUEUE_COUNT 5

// In place of the red of a sample that is not there yet: the bits of a NaN, and of no sample that is.
#define NO_SAMPLE 0xffffffffu

#define BLACKBODY_ENTRIES 4096

// Grids larger than a storage buffer may be lie in that many buffers, reached by address.
#define GRID_WINDOWS 16

#define TRACE_RECORDS 65536 // room for
#define TRACE_DEPART 0      // from the camera, or after scattering
#define TRACE_COLLISION 1   // a real one; its emission, and light known at once, are in the radiance
#define TRACE_LIGHT 2       // a shadow ray has ended
#define TRACE_ESCAPE 3      // into the background
#define TRACE_END 4
#define TRACE_SURFACE 5     // the path has come to one
#define TRACE_EMIT 6        // a particle, from its light
#define TRACE_KINDS 7

#define LAST_OF_LIST 0x80000000u // of media in a cell: set in the last one's word

#define LIGHT_ROW_TEXELS 8u
#define SURFACE_ROW_TEXELS 5u
#define SURFACE_SPARE 3.8147e-6 // 64 ulps of 1: see surfaces/surface_point.glsl
#define NO_LIGHT 0xffffffffu

#define NO_PIXEL 0xffffffffu

#endif
