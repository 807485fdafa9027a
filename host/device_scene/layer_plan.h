// Which layers a scene's picture has, and where each lies in a path's record: see shaders/film/aovs.glsl.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "film.h"
#include "scene.h"
#include "shared/frame.h"
#include "shared/items.h"

namespace vkvol {

struct LayerPlan {
    int kinds = 0;              // LAYERS_..., for kernels
    shared::AovParams params{}; // `records` is not for it to say
    unsigned wanted = 0;        // Aovs
    std::vector<std::string> groups, media;
};

// Throws InputError where these are too many.
LayerPlan plan_layers(const Scene& scene);

// Number of a light's group among the layers of groups; 0: none.
std::uint32_t group_layer(const std::vector<std::string>& groups, const std::string& group);

// The layers of media, none where these are not asked for; and the number of a medium's among them, 0 where there are
// none.
std::vector<std::string> media_layers(const Scene& scene);
std::uint32_t media_layer(const std::vector<std::string>& layers, const Scene& scene, std::size_t volume);

// What a picture's layers are on the host. `sums`: four for each layer of each pixel. `samples`: of each pixel.
// `origin`: of render space, in world space.
std::vector<FilmLayer> develop_layers(const LayerPlan& plan, std::span<const glm::vec3> sums,
                                      std::span<const std::uint32_t> samples, const glm::dvec3& origin);

} // namespace vkvol
