// From the authored scene to what kernels read of it: the frame's and the media's parameters.
#pragma once

#include "crop.h"
#include "loaded_medium.h"
#include "shared/frame.h"

namespace vkvol {

// World position of render space's origin: amid the media, or the surfaces, or the camera where there are none.
// `whole`: of several media, here and below, else null.
glm::dvec3 render_origin(const Scene& scene, Media media, const Superposition* whole = nullptr);

// Longest diagonal of the boxes around the media; world units, 0 where there is none.
double longest_diagonal(const Scene& scene, Media media, const Superposition* whole = nullptr);

// Half of that: within which lights matter. Of what is everywhere, a mean free path. `medium`: the frame's.
double lit_radius(const Scene& scene, const Assets& assets, const shared::MediumParams& medium);

// All but the lights of a table, and the fields that change during a render (crop_y) or belong to the queues.
shared::FrameParams make_frame(const Scene& scene, Media media, const Method& method, Crop crop, std::uint32_t seed,
                               const Superposition* whole = nullptr);

// A row for each of the media, in their order. `origin`: of render space.
std::vector<shared::MediumParams> make_media(const Scene& scene, Media media, const Method& method, glm::dvec3 origin);

} // namespace vkvol
