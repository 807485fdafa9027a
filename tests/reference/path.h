// One light path: the estimator of the radiance that arrives along a ray.
#pragma once

#include <optional>

#include "medium.h"
#include "rng.h"

namespace reference {

struct World {
    vkvol::Scene scene;
    std::optional<Medium> medium; // none: background only
    bool nee = false;             // next-event estimation towards the lights at real collisions
};

// Opens the scene's volume. Throws std::runtime_error for what the reference does not model.
World load_world(const vkvol::Scene& scene);

// `flight`: unit exponential variate of the first free flight.
vkvol::Rgb radiance(const World& world, Ray ray, double flight, Rng& rng);

// One sample of pixel (x, y) of the picture.
vkvol::Rgb trace_path(const World& world, int x, int y, std::uint32_t sample, std::uint32_t seed);

} // namespace reference
