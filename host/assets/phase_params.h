// Phase functions as kernels know them.
#pragma once

#include <span>

#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

// `nodes`: of a table, else empty.
shared::PhaseParams phase_params(const Volume& volume, std::span<const shared::PhaseNode> nodes);

// Iterations of the loops within phase functions in a turn of a kernel, at most; each with the one that ends it. A turn
// may draw a direction to scatter, and some to lamps, suns and maps from either end of a flight, and from along it.
std::uint32_t phase_iterations(const Volume& volume, std::span<const shared::PhaseNode> nodes);

// The function's value [1 / sr], mu being the cosine between the directions of travel before and after.
double phase_value(const Volume& volume, std::span<const shared::PhaseNode> nodes, double mu);

// At least the function's largest value [1 / sr]; of mixtures, and Draine's, it may be a few times that.
double phase_peak(const Volume& volume, std::span<const shared::PhaseNode> nodes);

// Mean of the cosine between the directions of travel before and after.
double mean_cosine(const Volume& volume, std::span<const shared::PhaseNode> nodes);

} // namespace vkvol
