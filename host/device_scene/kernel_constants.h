// The constants that kernels are compiled for: what a scene lacks compiles to nothing.
#pragma once

#include "loaded_medium.h"
#include "shared/items.h"
#include "specialization.h"

namespace vkvol {

// What is left of light at a collision; 0 in channels that do not scatter.
Rgb albedo_of(const Volume& volume);

// Radiance per absorption event: the medium's own, or its model's diffuse colour.
Rgb constant_emission(const Volume& volume, const LoadedMedium& loaded, const Method& method);

// Extinction or albedo differs between the colour channels, or may differ, as of surfaces.
bool is_chromatic(const Scene& scene);

// What a medium is to kernels, as one of several media that differ.
shared::MediumKinds kinds_of(const Volume& volume, const LoadedMedium& loaded, const Method& method);

// Value of every specialization constant. `whole`: of several media, else null.
Specialization specialize(const Scene& scene, Media media, const Method& method, const Superposition* whole = nullptr);

// Whether kernels have to be compiled with FULL, for constants that others do not have.
bool needs_full(const Specialization& constants);

// Whether shadow rays are walks of their own: SHADOW_RAYS_WALK of shapes/segment.glsl. `form`: of the kernels.
bool shadow_rays_walk(const Specialization& constants, unsigned form);

} // namespace vkvol
