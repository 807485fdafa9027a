// Surfaces, asked one by one, in double precision.
#pragma once

#include <optional>
#include <vector>

#include "rng.h"
#include "scene.h"
#include "shapes.h"

namespace reference {

struct SurfaceHit {
    double t;
    glm::dvec3 normal; // unit, outward
    glm::dvec3 smooth; // likewise, of what a face stands for
    const vkvol::Surface* surface;
    glm::dvec2 place = {}; // on its texture
};

// The nearest within the ray's reach.
std::optional<SurfaceHit> nearest_surface(const std::vector<vkvol::Surface>& surfaces, const Ray& ray);

// A direction that light may come from, and its share of what goes on along -travel: times the light from there its
// mean is what the surface scatters. `specular`: of one direction, or one of two. Drawn not as the renderer does.
struct Scattered {
    glm::dvec3 direction;
    vkvol::Rgb weight;
    bool specular;
};
Scattered scatter(const SurfaceHit& hit, const glm::dvec3& travel, const Draw& draw, Rng& rng);

// Share of light from `direction` that is scattered, per steradian, cosine included; 0 if what is there is specular. An
// estimate, if it is rough.
vkvol::Rgb scatter_value(const SurfaceHit& hit, const glm::dvec3& travel, const glm::dvec3& direction, Rng& rng);

} // namespace reference
