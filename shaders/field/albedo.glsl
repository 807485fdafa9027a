// The single-scattering albedo at a point: the medium's, times a grid's colour where the scene has one, which may be of
// numbers too. Beyond the box of its active voxels its outermost values go on, and what is above 1 counts as 1.
#ifndef ALBEDO_GLSL
#define ALBEDO_GLSL
#include "field/density.glsl"

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
    return albedo;
}

#endif
