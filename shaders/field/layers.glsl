// Density by height: exponential, as of an atmosphere in equilibrium, or by a map, whose values are heights.
#ifndef LAYERS_GLSL
#define LAYERS_GLSL
#include "field/value_map.glsl"
#include "shapes/shape.glsl"

// Above the bottom, of a point of medium space; of layers that are a map above the first of these [world units].
float layer_height(MediumParams v, vec3 p) {
    return max(dot(v.layers.up, p), 0.0) + v.layers.above;
}

// `map`: MAP_...
float layered_density(int map, MediumParams v, vec3 p) {
    float height = layer_height(v, p);
    float density = v.layers.bottom * exp(-v.layers.decay * height);
    if (map != MAP_NONE)
        density = mapped_density(map, v.first_knot, height);
    return density;
}

// An exponential along a ray is one as well: the logarithm of its density where the ray begins, which may be far below what has
// numbers, and what that loses per world unit. Hence optical depths and their inverse are closed forms.
struct Fading {
    float log_density;
    float rate;
};

Fading fading_along(MediumParams v, vec3 origin, vec3 direction) {
    return Fading(log(v.layers.bottom) - v.layers.decay * layer_height(v, origin), v.layers.decay * dot(v.layers.up, direction));
}

// The density's integral as far as t: where it is densest, at either end, times (1 - exp(-x)) / |rate|, x = |rate| t. Near 0 that
// cancels; there the series leaves 5e-8 out, beyond the difference loses 6e-7.
float faded_depth(Fading f, float t) {
    float x = abs(f.rate) * t;
    float series = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0)))));
    float mean = x < 0.25 ? series : (1.0 - exp(-x)) / x;
    return exp(f.log_density + (f.rate < 0.0 ? x : 0.0)) * t * mean;
}

// How far that integral is `depth`; FAR, if it never comes to that. -log(1 - y) / y, likewise, by 2 atanh(y / (2 - y)); where y is
// less than -1 by its logarithm, which has no bounds.
float faded_distance(Fading f, float depth) {
    float level = depth * exp(min(-f.log_density, 69.0));
    float y = f.rate * level;
    float z = y / (2.0 - y);
    float series = 2.0 / (2.0 - y) * (1.0 + z * z * (1.0 / 3.0 + z * z * (0.2 + z * z * (1.0 / 7.0))));
    float mean = abs(y) < 0.25 ? series : -log(max(1.0 - y, 1.0e-30)) / y;
    float log_y = log(max(-f.rate * depth, 1.0e-37)) - f.log_density;
    if (f.rate < 0.0 && log_y > 0.0)
        return (log_y + log(1.0 + exp(-log_y))) / -f.rate;
    return y < 1.0 ? level * mean : FAR;
}

#endif
