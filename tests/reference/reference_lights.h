// Lights other than an even background. Nothing here is shared with the renderer: every light is asked at every
// collision, none is weighted against flights, and a map is met by flights alone.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "rng.h"
#include "scene.h"
#include "shapes.h"

namespace reference {

// A map of the sky, in double precision.
struct Sky {
    int width = 0, height = 0;
    std::vector<vkvol::Rgb> texels; // times the light's scale
    double rotation = 0.0;          // degrees
    vkvol::SkyMapping mapping = vkvol::SkyMapping::equirectangular;

    vkvol::Rgb radiance(const glm::dvec3& direction) const;
};

// A place in the unit square, from its top left corner, of a map of equal areas; of the direction as such maps have it:
// z upwards, x to the right of the middle, y below it.
glm::dvec2 equal_area_place(const glm::dvec3& direction);
glm::dvec3 equal_area_direction(const glm::dvec2& place);

// That of the scene's lights which is a map. Throws std::runtime_error.
std::optional<Sky> load_sky(const std::vector<vkvol::Light>& lights);

// One direction towards a light from p, and what arrives per unit of transmittance, phase function and throughput, so
// that its mean over the random numbers is the light's whole. None: nothing arrives, or flights meet it.
struct Towards {
    Ray ray; // as far as the light
    vkvol::Rgb light;
};
std::optional<Towards> towards(const vkvol::Light& light, const glm::dvec3& p, double u, double v);

// Radiance of the disc of a sun in this direction; 0 of other lights.
vkvol::Rgb disc_radiance(const vkvol::Light& light, const glm::dvec3& direction);

// Where a ray meets the side of a lamp that shines at it; none of other lights.
std::optional<double> lamp_distance(const vkvol::Light& light, const Ray& ray);
vkvol::Rgb lamp_radiance(const vkvol::Light& light); // of a lamp

} // namespace reference
