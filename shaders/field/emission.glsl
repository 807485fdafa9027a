// Emission: the medium sends out sigma_a * density * Le per unit length, Le constant, or following a grid of temperatures or
// colours.
// Where density is 0 nothing is emitted, however hot. Estimated at real collisions, whose density is sigma_t * density:
// each adds beta * (1 - albedo) * Le; or along flights, by one sample per step or, of an even glow, in closed form.
#ifndef EMISSION_GLSL
#define EMISSION_GLSL
#include "field/albedo.glsl"

vec3 blackbody_entry(uint i) {
    return TABLE_TEXELS != 0 ? uintBitsToFloat(texelFetch(blackbody_texels, int(i)).xyz) : blackbody[i].xyz;
}

// Linear between the table's entries, the last of which is the hottest that the grid holds.
vec3 blackbody_color(EmissionParams e, float kelvin) {
    float x = clamp((kelvin - e.table_low) / (e.table_high - e.table_low), 0.0, 1.0) * float(BLACKBODY_ENTRIES - 1);
    uint i = min(uint(x), uint(BLACKBODY_ENTRIES - 2));
    return mix(blackbody_entry(e.first_entry + i), blackbody_entry(e.first_entry + i + 1u), x - float(i));
}

// What comes of the medium's own, and of grids of temperatures or colours.
vec3 grid_emission(MediumParams v, vec3 position) {
    EmissionParams e = v.emission;
    const int kind = KIND(EMISSION, v, emission), type = KIND(TEMPERATURE_TYPE, v, temperature_type);
    if (kind == EMISSION_NONE || kind == EMISSION_CONSTANT)
        return e.constant;
    vec4 p = vec4(position, 1.0);
    vec3 index = vec3(dot(e.to_index[0], p), dot(e.to_index[1], p), dot(e.to_index[2], p));
    index = clamp(index, vec3(e.grid.voxel_min - 2), vec3(e.grid.voxel_max + 2)); // beyond which there is nothing
    if (HAS_COLORS && type == GRID_COLOR)
        return e.constant + e.color * lookup_color(e.grid, GRID_COLOR, index);
    float value = lookup_value(e.grid, type, index);
    if (kind == EMISSION_COLOR)
        return e.constant + value * e.color;
    float kelvin = e.kelvin_scale * value + e.kelvin_offset;
    return kelvin < e.kelvin_cutoff ? e.constant : e.constant + e.color * blackbody_color(e, kelvin);
}

// (1 - albedo) * Le at a point of render space.
vec3 emitted_radiance(MediumParams v, vec3 position) {
    vec3 radiance = grid_emission(v, position);
    if (KIND(MAP, v, map) == MAP_GLOW)
        radiance += mapped_emission(v, mapped_value(v, position));
    bool varies = KIND(ALBEDO, v, albedo) == ALBEDO_GRID || KIND(MAP, v, map) >= MAP_ALBEDO;
    if (varies)
        radiance *= absorbed_at(v, position);
    return radiance;
}

#endif
