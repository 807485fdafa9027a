// The scene as the kernels see it. Render space has the axes and unit of world space and its origin amid the medium,
// so that single precision is spent on the medium, not on where the world's origin happens to be.
#ifndef SHARED_FRAME_H
#define SHARED_FRAME_H
#include "shared/constants.h"
#include "shared/prologue.h"

SHARED_BEGIN

// How rays leave, by kind of sensor: see camera.glsl.
struct SensorParams {
    vec3 position; // render space
    float start;   // distance from the eye of the plane where rays begin
    vec3 corner;
    vec3 right; // per pixel
    vec3 down;  // per pixel
    vec3 lens_u; // across the lens, its radius over the distance of what is sharp
    vec3 lens_v;
    float lens_lever;    // that distance less `start`
    uint blades;         // of its aperture; 0: round
    float blade_rotation; // radians
    vec2 first_angle;    // longitude, latitude
    vec2 angle_step;     // per pixel
    uint row;            // points in a row of the picture
    vec3 forward;        // unit
    ivec3 cells;         // of a box, their size being `corner`
};

// Where the layers of a path, or a pixel, begin: see aovs.glsl. Those of light are the first.
struct AovParams {
    uint count;   // of all
    uint records; // paths that have some, ahead of the pixels
    uint groups;  // of group 0 first, which is that of lights without one
    uint media;
    uint collision; // two: (w d, w, w d + w) of the distance d and the weight w; w times the position
    uint albedo;    // times w
    uint through;   // two: transmittance, and its mean over the channels
    uint normal;     // of the surface that is met first
};

// A grid within the buffers that hold all grids. Positions are in its index space, voxel centres at integers, counted
// from near the grid.
struct GridParams {
    ivec3 voxel_min; // active voxels, inclusive; 0 outside
    ivec3 voxel_max;
    ivec3 leaf_min; // first 8^3 block of the leaf table
    ivec3 leaf_dims;
    uint first_word;  // of the grid
    uint first_entry; // of its leaf table
};

// A grid of colours that multiply the albedo; see albedo.glsl.
struct AlbedoParams {
    GridParams grid;
    vec4 to_index[3]; // rows of the affine map render -> index space of that grid
};

// Radiance emitted per absorption event; see emission.glsl. Where the albedo is constant, all colours include the factor
// 1 - albedo, the chance that a collision is an absorption.
struct EmissionParams {
    vec3 constant;
    vec3 color;         // times temperature, or times the black body's colour
    GridParams grid;    // of temperatures or colours
    vec4 to_index[3];   // rows of the affine map render -> index space of that grid
    float kelvin_scale; // kelvin = scale * value + offset
    float kelvin_offset;
    float kelvin_cutoff; // colder than this does not glow
    float table_low;     // kelvin of the black-body table's first and last entry
    float table_high;
    uint first_entry; // of that table
};

// Where the density depends on height: exponentially, or by a map; see layers.glsl.
struct LayerParams {
    vec3 up;      // a point of medium space, times this, has that height above the bottom [world units]
    float bottom; // density there
    float decay;  // per world unit
    float above;  // of layers that are a map: how far medium space begins above the first of them [world units]
};

// Where the density is procedural; see noise.glsl. Each octave has its own map, so that its offset can be wrapped to
// the noise's period of 256 in double precision, however far the medium is from the world's origin.
struct NoiseParams {
    vec4 to_noise[16]; // per octave: w * position + xyz, render -> where its lattice has spacing 1
    uint octaves;
    float gain;
    uvec4 permutation[16]; // of 0 to 255, as bytes, the first in the lowest
};

// A node of the bounding volume hierarchy over a mesh's triangles, in depth-first order; see mesh.glsl.
struct BvhNode {
    vec3 low;
    uint skip; // the node to go to when the ray misses this one, or after a leaf; the number of nodes at the end
    vec3 high;
    uint leaf; // 0 for inner nodes; else first triangle * 8 + number of triangles, at most MESH_LEAF
};

// A control density in a majorant cell and the bound of the rest: |density - control| <= residual.
struct ControlCell {
    float control;
    float residual;
};

// How far a march goes at a time.
struct MarchParams {
    float step;         // world units
    float shadow_step;  // of shadow rays, world units
    float optical_step; // of adaptive marches: the majorant's optical depth
    float jitter;       // 1: sample points anywhere in their step; 0: in its middle
};

// What phase functions need; see shaders/phase.
struct PhaseParams {
    float g;     // Henyey and Greenstein's and Draine's, in (-1, 1)
    float g2;    // likewise of a second function,
    float share; // by which this part of the light goes; of Rayleigh's, that which does not go evenly
    float alpha; // of Draine's
    uint nodes;  // of a table, at least 2
    uint first_node;
};

// A node of a phase function that is a table.
struct PhaseNode {
    float x;     // 1 - mu, from 0 at the first to 2 at the last
    float value; // per steradian
    float share; // of the light that is scattered at smaller x; 1 at the last
};

// A knot of a map from a grid's values, and how much of each there is more per value from here to the next.
struct MapKnot {
    float value;
    float density;
    float density_slope;
    vec3 albedo; // multiplies the medium's
    vec3 albedo_slope;
    vec3 absorbed; // 1 - albedo, also where that is far below the last digit of 1
    vec3 absorbed_slope;
    vec3 emission; // radiance per absorption event
    vec3 emission_slope;
};

// What a medium of several is, where it is not the same for all of them: see EACH.
struct MediumKinds {
    int shape; // SHAPE_..., and so on
    int field;
    int grid_type;
    int phase;
    int emission;
    int temperature_type;
    int albedo;
    int albedo_type;
    int map;
};

// What a look-up asks of one of several media: four texels of the words in BINDING_OVERLAPS.
struct MemberRow {
    vec4 to_medium[3]; // as in MediumParams
    float sigma_t;     // likewise
    uint kinds;        // SHAPE_... | FIELD_... << 8 | GRID_... << 16 | MAP_... << 24
    uint grid;         // the first texel of its GridRow; of a mesh the first of its words, see inside.glsl
    uint first_knot;   // as in MediumParams
};

// Four texels as well.
struct GridRow {
    GridParams grid;
    uint unused[2];
};

// Where in those words what follows the rows begins.
struct OverlapParams {
    uint bricks; // of each coarse cell 0, or 1 + the number of the brick of finer cells that it is made of
    uint lists;  // of each cell, those of bricks last, where its list begins, or 0 if there is none; then the lists: media
    uint all;    // the list of all media
};

// Medium space: index space for a grid, voxel centres at integers; the unit ball or the cube [-1, 1]^3 for shapes.
struct MediumParams {
    vec4 to_medium[3]; // rows of the affine map render -> medium
    vec3 bounds_min;   // medium space; where the filtered density can differ from 0
    vec3 bounds_max;
    vec3 cells_min; // where majorant cells begin: at bounds_min, but where these are beyond all cells
    vec3 extent; // sphere, box, mesh: a point of medium space times this is one of render space
    GridParams density;
    ivec3 cell_dims;  // majorant cells, the first begins at cells_min
    float cell_size;  // edge of a cell, voxels
    float majorant;   // of the density, where there are no cells
    float control;    // likewise a control density
    float residual;   // and the bound of what differs from it
    float sigma_t;    // extinction at density 1, of the channel where it is largest [1 / world unit], > 0
    float usual_sigma_t; // what it comes to with the usual density, roughly
    vec3 sigma_ratio; // of the channels to that, in [0, 1]
    vec3 albedo;      // sigma_s / sigma_t
    vec3 absorbed;    // sigma_a / sigma_t, to all digits: of an albedo near 1 the difference to 1 has few
    AlbedoParams albedo_grid;
    PhaseParams phase;
    EmissionParams emission;
    NoiseParams noise;
    LayerParams layers;
    uint bvh_nodes; // of a mesh
    uint first_knot; // of the map
    MediumKinds kinds;
    float look_density; // of what glows: per volume, of looks toward it; 0 if there are none. See glowing.glsl
    uint layer; // among those of media
};

// Nodes over the medium's box, z fastest. Lattices of these dimensions lie one after the other: of the density, and of
// optical depths, towards the sun or in each of CACHE_DIRECTIONS directions. See lattice.glsl.
struct LatticeParams {
    vec3 low;     // medium space, the first node
    vec3 spacing; // medium space
    ivec3 dims;   // at least 2 along each axis
};

// An entry of a table from which i is drawn with a given probability, by one look-up: of a uniformly random entry its own number with
// probability keep / 2^32, else `other` (Walker's alias method).
struct AliasEntry {
    uint keep;
    uint other;
};

// A light of several; which fields mean something depends on its kind.
struct LightRow {
    uint kind; // LIGHT_..., with what is known of it
    AliasEntry alias;
    float chance;    // with which it is chosen; of the first that is in a tree, with which the tree is
    vec3 position;   // render space
    float extent;    // of a disc: 1 - cos of the angle from its middle to its rim; of a sphere its radius; of what glows
                     // its extinction at most [1 / world unit]
    vec3 direction;  // unit: towards the light, where it is infinitely far; of a spot, along its axis; of what is flat, its normal
    float darkening; // of a disc toward its rim, in [0, 1]
    vec3 edge_u;     // halves of the edges of a rectangle, or radii of a disk; across each other; of what glows, with its
                     // direction, likewise of its cube or ball
    float area;      // of a lamp, as seen from in front; of a surface, of all pieces, on one side; of what glows its volume
    vec3 edge_v;
    uint group;      // of layers
    vec3 radiance;   // from everywhere on it, of a disc from its middle; of a directional light its irradiance, of a point the
                     // radiant intensity, of what glows that of a unit of volume
    uint body;       // of a lamp that is a surface, that; else NO_SURFACE
    float full_within; // of a spot, 1 - cos of angles to its axis: full intensity within,
    float none_beyond; // none beyond
    float apart;     // from its place: so far on no surface that it lies in is before it, by rounding
    float look_density; // of a surface: per area, of looks toward it, as weights have it; see shining.glsl. Of what glows per volume
    uint first_piece;   // the first of the rows of BINDING_EMITTERS that are its pieces, or the medium that glows
    uint pieces;        // and how many these are, or 1 + its layer among those of media
    uint sides;         // that shine: 1 or 2; of what glows, of its cube: 6, of a ball 0
    uint unused;        // so that it is whole texels: see lights/row.glsl
};

// A surface; which fields mean something depends on its kinds.
struct SurfaceRow {
    vec3 color;    // share of the light that it scatters, of a conductor times Fresnel's
    float roughness; // GGX's alpha
    vec3 emission; // radiance, from its front, or from both sides
    uint material; // MATERIAL_...
    vec3 eta;      // index of refraction, of a dielectric the same in all channels: of its inside to that of its outside
    uint sides;    // that shine: 1 or 2
    vec3 k;        // of a conductor, the index's imaginary part; of what is coated, x: what its coat throws back at it
    uint texture;  // that multiplies the colour: 1 and where it is in BINDING_SKY; or 0
    float look_density; // per area, of looks toward it; 0 if there are none. See shining.glsl
    uint unused[3];
};

// A piece of a surface that a ray meets at once. Render space.
struct SurfacePrimitive {
    vec3 a; // a triangle's corners, counterclockwise as seen from without; or a middle,
    uint surface; // its row
    vec3 b; // a unit normal
    uint shape; // SURFACE_...
    vec3 c; // and the radius, in x
    uint details; // a piece that rays do not meet, DETAIL_..., or 0
};

// A node of a binary tree over lights, in depth-first order; a branch's left one follows it.
struct LightNode {
    vec3 low; // bounds of all lights below, render space
    vec3 high;
    float power; // of all of them
    float power_in_matter; // likewise; spots count for less, the fewer of the media they shine on
    uint light;  // its row; NO_LIGHT of a branch
    uint right;
    vec3 axis;    // unit, about which they shine
    float spread; // cosine of the most that a light's own axis is off it; -1: some shine into all directions
    float reach;  // cosine of the most that light is off its light's axis
};

// What sends out particles, see emit.glsl; or a piece of a surface that is looked for, see shining.glsl.
struct EmitterRow {
    AliasEntry alias;
    float chance; // with which it is chosen
    uint source;  // SOURCE_..., or a light's row, or AT_SURFACE + a primitive's number
};

struct ParticleParams {
    float radius;      // of a ball about the origin that holds all that is to be lit from afar; 0: nothing comes from there
    uint first_emitter; // of the rows to choose among: behind the pieces of surfaces that are looked for
    uint emitters;     // how many
    float power;       // of all of them together, roughly: a particle's throughput is in units of it
    float glow_volume; // of the box about the media [world units^3],
    vec3 glow_corner;  // and where that is
    vec3 glow_edges[3];
    float unit;        // in which splats count
    vec3 open;         // of a domain that repeats along two axes, 1 along the third,
    float above;       // and where along that there is nothing beyond, nor below
    float below;
    vec3 sensor_low;   // of a box about a sensor of flux, render space
};

// A map of the sky, see sky.glsl.
struct SkyParams {
    uint width; // texels
    uint height;
    float turn; // added to a direction's longitude, in turns
};

// Lights that are known without a choice.
struct LightParams {
    vec3 direction; // unit, towards the light; none of the background
    vec3 radiance;  // of the background, from everywhere; of the sun its irradiance across `direction`
    uint group;     // of layers
};

// A domain that repeats along axes of the world, and where along the others there is anything: see period.glsl. Render space.
struct PeriodParams {
    vec3 low;
    vec3 size; // world units; 0 along axes that do not repeat
    vec3 range_low; // infinitely far along those that do
    vec3 range_high;
};

struct FrameParams {
    SensorParams sensors[MOST_SENSORS];
    MediumParams media[MOST_MEDIA];
    LightParams lights[MOST_LIGHTS]; // FRAME_BACKGROUND, FRAME_DIRECTIONAL
    uint choices;                    // rows of the table to choose among; where there is a tree, the last of them stands for that
    uint sky_count;                  // the first rows: those that flights meet by themselves
    uint lamp_first;                 // rows of the lamps
    uint lamp_count;
    SkyParams sky;
    uint first_surface_node; // of the hierarchy over all surfaces, which follows that of a medium's mesh
    uint surface_nodes;
    uint planes;             // the first primitives are these
    MarchParams march;
    OverlapParams overlaps; // several media only
    LatticeParams lattice; // NEE_CACHED only
    float fluence;         // of all lights of a table, amid the medium, roughly
    vec3 cache_suns[CACHE_SUNS]; // unit; 0: none
    float filter_quantiles[FILTER_QUANTILES + 1]; // of a pixel's filter: distance from the middle, pixels
    float roulette_threshold;
    uint max_depth;
    AovParams layers;
    ParticleParams particles;
    PeriodParams period;
    uint seed;
    uint crop_x; // the crop's first pixel within the picture
    uint crop_y;
    uint crop_width;
    uint crop_height;
    uint slots;                       // fused: pixels in work; staged: paths
    uint queue_capacity;              // a power of two, at least 2 * slots; see queue.glsl
    uvec2 grid_windows[GRID_WINDOWS]; // device addresses, low and high word; see grid.glsl
};

// The same for all passes.
struct PassPush {
    uint queue;        // prepare: the queue whose consumer comes next
    uint before;       // prepare: a queue that its invocations take from first, prepared already; or the same
    uint lanes;        // prepare: how many invocations may share the queue
    uint sample_begin; // of the batch
    uint sample_end;
    uint pixel_begin; // sky: range of film entries
    uint pixel_end;
    uint work_end;   // hand out nothing of the work list from here on, counted as counters.next_work
    uint places;     // staged: pixels whose samples may wait to be added to the film
    uint budget;     // loop iterations after which a lane takes no further item
    uint step_limit; // steps after which a flight is cut, counted as a cap
    uint node_begin; // average, shade: the first of the lattice's nodes that they fill
    uint lattice;    // shade: which one is filled, and towards where (unit)
    vec3 towards;
};

SHARED_END
#endif
