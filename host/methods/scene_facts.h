// What a scene is like, as far as that decides how it can be rendered.
#pragma once

#include "scene.h"

namespace vkvol {

// Several media, whose extinctions add up.
bool is_superposition(const Scene& scene);

// Several that are even, of one colour's extinction, and few: what each takes away along a ray is a closed form.
bool are_even_together(const Scene& scene);
// Whether shadow rays through such are to be closed forms, as they are unless told to walk, or to be cached where that
// can be.
bool sees_at_once(const Scene& scene);

// FIELD_..., FIELD_CONSTANT without a volume.
int density_kind(const Scene& scene);
bool has_chromatic_extinction(const Scene& scene); // sigma_t differs between channels
// Where transmittances towards lights can be cached: there are any, the density varies, the shape is no mesh, and no
// surface is in the way.
bool can_cache_light(const Scene& scene);
bool can_scatter(const Volume& volume);
bool glows(const Volume& volume); // judged by coefficients: the temperature grid may be missing
bool emits(const Scene& scene);   // whether one of its media glows

bool has_map(const Scene& scene); // of values to what a medium is, for one of its media at least
bool fades(const Scene& scene);   // the density of its one volume falls exponentially with height

} // namespace vkvol
