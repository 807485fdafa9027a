// Phase functions as kernels know them.
#pragma once

#include <span>

#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

// `nodes`: of a table, else empty.
shared::PhaseParams phase_params(const Volume& volume, std::span<const shared::PhaseNode> nodes);

// Of the cosine between the directions of travel before and after.
double mean_cosine(const Volume& volume, std::span<const shared::PhaseNode> nodes);

} // namespace vkvol
