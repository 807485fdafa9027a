// What can be read but not rendered: too many things of a kind, things that do not go together, media that no patience
// suffices for, and figures beyond single precision.
#pragma once

#include "loaded_medium.h"

namespace vkvol {

// Throws InputError, in one line, for a scene of more media, maps of the sky, lamps or suns than the kernels have room
// or time for, for what cannot be in a domain that repeats, and for points that lie in surfaces.
void check_scene_limits(const Scene& scene);

// Sensors of flux in endless planes, which read what is behind them. `origin`: of render space. Throws InputError.
void check_sensor_in_planes(const Scene& scene, const glm::dvec3& origin);

// Throws InputError with the figure and the remedy.
void check_limits(const Scene& scene, const Volume& volume, const LoadedMedium& loaded, const Method& method);

// The same for several media, among which cells may be coarse for a small one.
void check_limits(const Scene& scene, const Superposition& whole, const Method& method);

// Throws InputError for media that are everywhere and together too thin to be met, or lose too little ever to end a
// path. `scattering`: SCATTERING_*; the first collision of a single one ends it.
void check_everywhere(const Scene& scene, const std::vector<LoadedMedium>& media, int scattering);

// Throws InputError for a domain that repeats along all axes and loses too little ever to end a path; likewise.
void check_way_out(const Scene& scene, const std::vector<LoadedMedium>& media, int scattering);

// Lights that are infinitely far, in a scene with an even medium without end, which lets none of theirs through. Empty:
// none.
std::string lights_shut_out(const Scene& scene);

// What is rendered, but not well: mean free paths that are hardly more than places are known to. Empty: none.
std::string too_short_paths(const Scene& scene, const Volume& volume, const LoadedMedium& loaded);

} // namespace vkvol
