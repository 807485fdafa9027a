// The single-scattering albedo at a point: the medium's, times a grid's colour where the scene has one, which may be of
// numbers too, and times what the density's grid is mapped to. Beyond the box of a grid of albedos its outermost values go
// on, and what is above 1 counts as 1.
#ifndef ALBEDO_GLSL
#define ALBEDO_GLSL
#include "field/density.glsl"
#include "shapes/shape.glsl"

// What the medium's map is of, at a point of render space: the density's grid, as interpolated for the density, or height.
float mapped_value(MediumParams v, vec3 position) {
#ifdef SEVERAL
    const int field = KIND(MEMBER_FIELD, v, field);
#else
    const int field = FIELD;
#endif
    vec3 p = to_medium(v, position, vec3(0.0)).origin;
    float value = layer_height(v, p);
    if (field == FIELD_GRID)
        value = lookup(v.density, KIND(GRID_TYPE, v, grid_type), p, vec3(0.0));
    return value;
}

// The grid's colour at a point of render space.
vec3 albedo_of_grid(MediumParams v, vec3 position) {
    vec4 p = vec4(position, 1.0);
    AlbedoParams a = v.albedo_grid;
    vec3 index = vec3(dot(a.to_index[0], p), dot(a.to_index[1], p), dot(a.to_index[2], p));
    index = clamp(index, vec3(a.grid.voxel_min), vec3(a.grid.voxel_max));
    return min(lookup_color(a.grid, KIND(ALBEDO_TYPE, v, albedo_type), index), vec3(1.0));
}

// `position`: of render space.
vec3 albedo_at(MediumParams v, vec3 position) {
    vec3 albedo = v.albedo;
    if (KIND(ALBEDO, v, albedo) == ALBEDO_GRID)
        albedo *= albedo_of_grid(v, position);
    if (KIND(MAP, v, map) >= MAP_ALBEDO)
        albedo *= mapped_albedo(v, mapped_value(v, position));
    return albedo;
}

// What of a collision there is no scattering: 1 - albedo, with all digits where that is small.
vec3 absorbed_at(MediumParams v, vec3 position) {
    vec3 albedo = v.albedo, absorbed = v.absorbed;
    if (KIND(ALBEDO, v, albedo) == ALBEDO_GRID) {
        vec3 color = albedo_of_grid(v, position);
        absorbed += albedo * (1.0 - color);
        albedo *= color;
    }
    if (KIND(MAP, v, map) >= MAP_ALBEDO)
        absorbed += albedo * mapped_absorbed(v, mapped_value(v, position));
    return absorbed;
}

#endif
