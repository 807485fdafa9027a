// Several media as one: cells over the box around all of them, with bounds of the sum of their extinctions. See
// shaders/field/superposition.glsl.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "majorant_grid.h"
#include "method.h"

namespace vkvol {

struct LoadedMedium;

// Its space is that of render space, axes along the world's, in units of a cell.
struct Superposition {
    glm::dvec3 origin{0.0}; // of that space, world: amid the box
    double edge = 1.0;      // of a cell, world units
    MajorantGrid cells;     // `cell` 1; bounds of the extinction of the channel where it is largest [1 / world unit]
    // Of each cell where its list begins, and where the last one ends; then the lists: media, by their number in the
    // scene.
    std::vector<std::uint32_t> overlaps;
    std::uint32_t most_overlaps = 0; // of a cell

    glm::dvec3 low() const { return glm::dvec3(cells.origin); } // in its space
    glm::dvec3 high() const { return glm::dvec3(cells.origin + cells.dims); }
    double diagonal() const { return edge * glm::length(high() - low()); } // world units
};

// Of media that have been loaded for `scene`. None of them need have any matter; then there are no cells. Throws
// InputError if they lie too far apart for their sizes.
Superposition superpose(const Scene& scene, std::span<const LoadedMedium> media, const Method& method);

} // namespace vkvol
