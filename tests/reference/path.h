// One light path: the estimator of the radiance that arrives along a ray.
#pragma once

#include <optional>

#include "medium.h"
#include "reference_lights.h"
#include "reference_method.h"
#include "rng.h"

namespace reference {

struct World {
    vkvol::Scene scene;
    std::optional<Medium> medium; // none: background only
    Method method;
    std::optional<Sky> sky = std::nullopt;
    std::vector<Medium> others = {}; // beside it, where there are several
};

// Opens the scene's volume and resolves its integrator. Throws std::runtime_error for what the reference does not model
// and for choices that do not go together.
World load_world(const vkvol::Scene& scene);
// Likewise, with a medium that is open already.
World make_world(const vkvol::Scene& scene, Medium medium);

// `exponential`: unit exponential variate of the first free flight; `select`: chooses its channel.
vkvol::Rgb radiance(const World& world, Ray ray, double exponential, double select, Rng& rng);

// One sample of pixel (x, y) of the picture.
vkvol::Rgb trace_path(const World& world, int x, int y, std::uint32_t sample, std::uint32_t seed);

// Radiance from all lights that flights do not meet, scattered at p by `medium` into the path that travels along
// `travel`, per unit of scattered throughput.
vkvol::Rgb direct_light(const World& world, const Medium& medium, const glm::dvec3& p, const glm::dvec3& travel,
                        Rng& rng);

// Radiance that comes from far away along `direction`, and that direct_light leaves to flights; `at_camera`: all there
// is.
vkvol::Rgb light_from_beyond(const World& world, const glm::dvec3& direction, bool at_camera);

// Lamps in sight of the camera, through the medium.
vkvol::Rgb lamps_seen(const World& world, const Ray& ray, Rng& rng);

// Through all media; 0 where a surface is in the way.
vkvol::Rgb transmittance(const World& world, const Ray& ray, Rng& rng);

// The radiance where there are several media, or surfaces, by a race: see race.cpp.
vkvol::Rgb radiance_by_race(const World& world, Ray ray, Rng& rng);

// Does a path of this method collide nowhere, and sum up what it passes?
bool marches_through(const Method& method);
vkvol::Rgb march_through(const World& world, const Ray& ray, Rng& rng);

} // namespace reference
