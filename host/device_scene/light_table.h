// The lights as the kernels choose among them: see shaders/lights/table.glsl.
#pragma once

#include <optional>
#include <vector>

#include "loaded_medium.h"
#include "shared/frame.h"

namespace vkvol {

struct LightTable {
    std::vector<shared::LightRow> rows; // first those that flights meet by themselves
    std::uint32_t sky_count = 0;        // how many these are
};

// LIGHTS_...: what has to be done to see all of them. `sky`: whether the scene has a map of it.
int lights_kind(const std::vector<Light>& lights);

// `origin`: of render space, world; `radius`: of the media about it. A look's chance to go toward a light is in
// proportion to the light's fluence amid the media, and never less than a tenth of an even share.
LightTable make_light_table(const Scene& scene, const Assets& assets, const glm::dvec3& origin, double radius);

shared::SkyParams make_sky_params(const Scene& scene, const Assets& assets);

} // namespace vkvol
