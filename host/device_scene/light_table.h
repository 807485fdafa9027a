// The lights as the kernels choose among them: see shaders/lights/table.glsl.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "loaded_medium.h"
#include "shared/frame.h"
#include "surface_table.h"

namespace vkvol {

inline double channel_mean(const Rgb& color) {
    return (color.x + color.y + color.z) / 3.0;
}

struct LightTable {
    std::vector<shared::LightRow> rows;
    std::vector<shared::LightNode> tree; // over those that are somewhere, if there are several
    std::vector<glm::vec3> suns;         // CACHE_SUNS at most: towards those far lights that are no small part of all
    std::vector<double> powers; // of each row; of what is far, of the first lamp_first, through a unit of area; 0 of
                                // surfaces and media, whose pieces send out their particles themselves
    std::vector<shared::EmitterRow> pieces; // of all surfaces among the rows, in their order
    float fluence = 0.0f;                   // of all, amid the media, roughly; > 0
    std::uint32_t choices = 0, sky_count = 0, lamp_first = 0, lamp_count = 0; // see FrameParams
};

// LIGHTS_...: what has to be done to see all of them.
int lights_kind(const Scene& scene);

// `origin`: of render space, world; `radius`: of the media about it. A look's chance to go toward a light, or
// toward the tree, is in proportion to its fluence amid the media, and never less than a tenth of an even share.
LightTable make_light_table(const Scene& scene, const Assets& assets, const SurfaceTable& surfaces,
                            const glm::dvec3& origin, double radius);

// To surfaces that are lights, for flights that meet them.
void tell_look_densities(const LightTable& table, SurfaceTable& surfaces);
// To media that are.
void tell_look_densities(const LightTable& table, std::span<shared::MediumParams> media);

// Iterations of the loops in which a kernel asks all of some kind, or goes down the tree; each with the one that ends
// it.
std::uint32_t loop_iterations(const Scene& scene);

// World units: how far from `origin` lamps reach; 0 without any.
double reach_of_lamps(const std::vector<Light>& lights, const glm::dvec3& origin);

shared::SkyParams make_sky_params(const Scene& scene, const Assets& assets);

} // namespace vkvol
