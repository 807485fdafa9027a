// What there is at a point. Where a scene has several media their extinctions add up: then the medium that walks go through is
// the superposition of all, whose cells bound that sum and list which of them may be there, and what a path collides with
// is one of them, by its share. Hence every estimator that knows its medium by look-ups alone serves several as it serves one.
#ifndef SUPERPOSITION_GLSL
#define SUPERPOSITION_GLSL
#include "field/density.glsl"
#include "field/inside.glsl"
#include "majorants/cells.glsl"
#include "lib/rng.glsl"
#include "shapes/shape.glsl"

struct Matter {
    float density;  // in units of the medium's sigma_t
    uint medium;    // of several, the row of one, drawn by its share of the extinction
    Spectrum ratio; // of the channels' extinction to that of the largest
    Spectrum share; // of the medium in a channel's extinction, over the chance with which it was drawn
};

// The part of a superposition that is to be asked for what collisions need: phase function, albedo.
MediumParams medium_of(MediumParams v, uint row) {
#ifdef SEVERAL
    return media[row];
#else
    return v;
#endif
}

#ifdef SEVERAL
uvec4 member_texel(uint i) {
    return TEXELS != 0 ? texelFetch(member_texels, int(i))
                       : uvec4(overlaps[4u * i], overlaps[4u * i + 1u], overlaps[4u * i + 2u], overlaps[4u * i + 3u]);
}

// The one grid of all media that are grids, or that of a GridRow.
GridParams member_grid(MediumParams v, uint row) {
    GridParams grid = v.density;
    if (MEMBER_GRID == EACH) {
        uvec4 a = member_texel(row), b = member_texel(row + 1u), c = member_texel(row + 2u), d = member_texel(row + 3u);
        grid = GridParams(ivec3(a.xyz), ivec3(a.w, b.xy), ivec3(b.zw, c.x), ivec3(c.yzw), d.x, d.y);
    }
    return grid;
}

// Extinction of one of them at a point of render space.
float extinction_of(MediumParams v, uint row, vec3 position, vec3 tap) {
    vec4 at = vec4(position, 1.0);
    vec3 p = vec3(dot(uintBitsToFloat(member_texel(4u * row)), at), dot(uintBitsToFloat(member_texel(4u * row + 1u)), at),
                  dot(uintBitsToFloat(member_texel(4u * row + 2u)), at));
    uvec4 rest = member_texel(4u * row + 3u); // see MemberRow
    const int shape = MEMBER_SHAPE < 0 ? int(rest.y & 255u) : MEMBER_SHAPE;
    const int field = MEMBER_FIELD == EACH ? int(rest.y >> 8u & 255u) : MEMBER_FIELD;
    const int type = GRID_TYPE == EACH ? int(rest.y >> 16u & 255u) : GRID_TYPE;
    const int map = MAP == EACH ? int(rest.y >> 24u) : MAP;
    bool inside = shape == SHAPE_SPHERE ? dot(p, p) < 1.0 : all(lessThanEqual(abs(p), vec3(1.0)));
    if (HAS_MODELS) {
        if (shape == SHAPE_MESH)
            inside = inside_mesh(rest.z, p);
    }
    float found = 1.0;
    if (field == FIELD_NOISE) {
        found = noise_density(media[row].noise, row, media[row].extent * p);
    } else if (field == FIELD_LAYERS) {
        inside = all(greaterThanEqual(p, vec3(0.0))) && all(lessThanEqual(p, media[row].bounds_max));
        found = layered_density(map, media[row], p);
    } else if (field == FIELD_GRID) {
        GridParams grid = member_grid(v, rest.z);
        vec3 low = vec3(grid.voxel_min - 1), high = vec3(grid.voxel_max + 1);
        inside = all(greaterThanEqual(p, low)) && all(lessThanEqual(p, high));
        found = mapped_density(map, rest.w, lookup(grid, type, p, tap));
    }
    return inside ? uintBitsToFloat(rest.x) * found : 0.0;
}

// The medium at a place of a list, and whether there are more behind it.
uint listed(uint k, out bool more) {
    uint word = overlap_word(k);
    uint row = word & ~LAST_OF_LIST;
    more = row == word;
    return row;
}

// Optical depth from a point of render space on, `reach` world units along a ray, where all are even balls and boxes, or everywhere:
// each adds what it has of its own.
float depth_of_all(vec3 position, vec3 direction, float reach) {
    vec4 at = vec4(position, 1.0);
    float depth = 0.0;
    uint k = frame.overlaps.all;
    for (bool more = true; more; ++k) { // at most MOST_EVEN_MEDIA
        uint row = listed(k, more);
        vec4 x = uintBitsToFloat(member_texel(4u * row)), y = uintBitsToFloat(member_texel(4u * row + 1u)),
             z = uintBitsToFloat(member_texel(4u * row + 2u));
        uvec4 rest = member_texel(4u * row + 3u);
        Ray ray = Ray(vec3(dot(x, at), dot(y, at), dot(z, at)),
                      vec3(dot(x.xyz, direction), dot(y.xyz, direction), dot(z.xyz, direction)));
        const int shape = MEMBER_SHAPE < 0 ? int(rest.y & 255u) : MEMBER_SHAPE;
        vec2 of_ball, of_box;
        bool meets_ball = intersect_unit_ball(ray, of_ball), meets_box = intersect_box(ray, vec3(-1.0), vec3(1.0), of_box);
        vec2 t = shape == SHAPE_SPHERE ? of_ball : of_box;
        bool met = shape == SHAPE_SPHERE ? meets_ball : meets_box;
        depth += met ? uintBitsToFloat(rest.x) * max(min(t.y, reach) - t.x, 0.0) : 0.0;
    }
    return depth;
}

// In a cell of that entry, at a point of the superposition's space, which is that of render space in units of a cell. `u` in
// [0, 1), for the draw; `tap`: see density.glsl. Media are drawn as they extinguish throughput `beta`, as spectral flights
// choose what happens: drawn by the channel that is extinguished most, a path of one colour would gain weight at each collision
// that media of other colours could have had, and its variance would have no bound.
Matter matter_in(MediumParams v, uint entry, vec3 p, vec3 tap, float u, Spectrum beta) {
    Matter found = Matter(0.0, 0u, to_spectrum(vec3(1.0)), to_spectrum(vec3(1.0)));
    float sum = 0.0; // of what is drawn by
#ifdef CHROMATIC
    float all = total(abs(beta)), drawn_by = 0.0;
    vec3 parts = all > 0.0 ? abs(beta) / all : vec3(1.0);
    vec3 channels = vec3(0.0), own = vec3(0.0);
#endif
    uint k = overlap_word(frame.overlaps.lists + entry);
    for (bool more = k != 0u; more; ++k) {
        uint row = listed(k, more);
        float sigma_t = extinction_of(v, row, v.extent * p, tap);
        found.density += sigma_t;
        float part = sigma_t;
#ifdef CHROMATIC
        vec3 extinguished = sigma_t * media[row].sigma_ratio;
        part = total(parts * extinguished);
#endif
        float before = sum;
        sum += part;
        // The smaller chance is that of small numbers, which have more digits: behind an even choice they are steps of 2^-23.
        float share = part > 0.0 ? part / sum : 0.0, rest = part > 0.0 ? before / sum : 1.0, less = min(share, rest);
        bool is_less = u < less, drawn = is_less == (share <= rest);
        found.medium = drawn ? row : found.medium;
        u = is_less ? u / less : (u - less) / max(share, rest); // uniform again
#ifdef CHROMATIC
        channels += extinguished;
        own = drawn ? extinguished : own;
        drawn_by = drawn ? part : drawn_by;
#endif
    }
#ifdef CHROMATIC
    found.ratio = found.density > 0.0 ? channels / found.density : found.ratio;
    found.share = mix(own / channels * (sum / drawn_by), vec3(1.0), equal(channels, vec3(0.0)));
    found.share = drawn_by > 0.0 ? found.share : vec3(1.0);
#endif
    return found;
}

// That of the cell at a point of the superposition's space.
uint entry_at(MediumParams v, vec3 p) {
    int edge;
    ivec3 cell = ivec3(clamp(floor(p - v.cells_min), vec3(0.0), vec3(v.cell_dims - 1)));
    return cell_entry(v, cell, edge);
}

// Where the list of media that may be there begins, or 0 if there is none.
uint list_at(MediumParams v, vec3 p) {
    return overlap_word(frame.overlaps.lists + entry_at(v, p));
}

Matter matter_at(MediumParams v, vec3 p, vec3 tap, float u, Spectrum beta) {
    return matter_in(v, entry_at(v, p), p, tap, u, beta);
}

float density(MediumParams v, vec3 p, vec3 tap) {
    return matter_at(v, p, tap, 0.0, to_spectrum(vec3(1.0))).density;
}
float to_choice(uvec4 words) {
    return to_event(pcg4d(words));
}
#else
Matter matter_at(MediumParams v, vec3 p, vec3 tap, float u, Spectrum beta) {
    return Matter(density(v, p, tap), 0u, to_spectrum(v.sigma_ratio), to_spectrum(vec3(1.0)));
}
Matter matter_in(MediumParams v, uint entry, vec3 p, vec3 tap, float u, Spectrum beta) {
    return matter_at(v, p, tap, u, beta);
}
float to_choice(uvec4 words) {
    return 0.0;
}
#endif

#endif
