// The single-scattering albedo at a point: the medium's, times a grid's colour where the scene has one, which may be of
// numbers too, and times what the density's grid is mapped to. Beyond the box of a grid of albedos its outermost values go
// on, and what is above 1 counts as 1.
#ifndef ALBEDO_GLSL
#define ALBEDO_GLSL
#include "field/density.glsl"
#include "shapes/shape.glsl"

// The density's grid at a point of render space, for its map: as interpolated for the density.
float mapped_value(MediumParams v, vec3 position) {
    return lookup(v.density, KIND(GRID_TYPE, v, grid_type), to_medium(v, position, vec3(0.0)).origin, vec3(0.0));
}

// `position`: of render space.
vec3 albedo_at(MediumParams v, vec3 position) {
    vec3 albedo = v.albedo;
    if (KIND(ALBEDO, v, albedo) == ALBEDO_GRID) {
        vec4 p = vec4(position, 1.0);
        AlbedoParams a = v.albedo_grid;
        vec3 index = vec3(dot(a.to_index[0], p), dot(a.to_index[1], p), dot(a.to_index[2], p));
        index = clamp(index, vec3(a.grid.voxel_min), vec3(a.grid.voxel_max));
        albedo *= min(lookup_color(a.grid, KIND(ALBEDO_TYPE, v, albedo_type), index), vec3(1.0));
    }
    if (KIND(MAP, v, map) >= MAP_ALBEDO)
        albedo *= mapped_albedo(v, mapped_value(v, position));
    return albedo;
}

#endif
