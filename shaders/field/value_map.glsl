// A map from the values of a grid, as interpolated, to densities, albedos and emission: linear between knots.
//
// A table has 2^MAP_HALVINGS knots, the first of them at 0, the last ones at infinity where there are fewer; of two knots of
// one value the latter counts from there on. Where it is searched no lane goes a way of its own.
#ifndef VALUE_MAP_GLSL
#define VALUE_MAP_GLSL
#include "lib/buffers.glsl"

// The last that is not above the value.
uint map_knot(uint first_knot, float value) {
    uint at = first_knot;
    [[unroll]] for (int bit = MAP_HALVINGS - 1; bit >= 0; --bit) {
        uint next = at + (1u << uint(bit));
        at = map_knots[next].value <= value ? next : at;
    }
    return at;
}

// `map`: MAP_...
float mapped_density(int map, uint first_knot, float value) {
    float density = value;
    if (map != MAP_NONE) {
        MapKnot knot = map_knots[map_knot(first_knot, value)];
        density = max(knot.density + (value - knot.value) * knot.density_slope, 0.0);
    }
    return density;
}

// Density for a value, by the map of a lone medium. In an `if` of its own, which kernels without maps are compiled without.
float mapped(MediumParams v, float value) {
    float density = value;
    if (MAP != MAP_NONE)
        density = mapped_density(MAP, v.first_knot, value);
    return density;
}

vec3 mapped_albedo(MediumParams v, float value) {
    MapKnot knot = map_knots[map_knot(v.first_knot, value)];
    return clamp(knot.albedo + (value - knot.value) * knot.albedo_slope, vec3(0.0), vec3(1.0));
}

vec3 mapped_absorbed(MediumParams v, float value) {
    MapKnot knot = map_knots[map_knot(v.first_knot, value)];
    return clamp(knot.absorbed + (value - knot.value) * knot.absorbed_slope, vec3(0.0), vec3(1.0));
}

vec3 mapped_emission(MediumParams v, float value) {
    MapKnot knot = map_knots[map_knot(v.first_knot, value)];
    return max(knot.emission + (value - knot.value) * knot.emission_slope, vec3(0.0));
}

#endif
