// Several media as one: cells over the box around all of them, with bounds of the sum of their extinctions, and lists
// of who may be there. See shaders/field/superposition.glsl and shaders/majorants/cells.glsl.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "majorant_grid.h"
#include "method.h"

namespace vkvol {

struct LoadedMedium;

// Its space is that of render space, axes along the world's, in units of a cell. Where cells as fine as small media
// want them would be too many for the whole box, it has coarse cells, and those where small media are are bricks of
// finer ones. Entries of tables are those of coarse cells, or of all if there are no others, z fastest; then those of
// bricks, likewise. Where media are everywhere, its outermost cells go on for ever, and what bounds them bounds all
// that is beyond.
struct Superposition {
    glm::dvec3 origin{0.0}; // of that space, world: amid the media
    double edge = 1.0;      // of a cell, world units
    int bits = 0;           // log2 of the cells along the edge of a coarse one; 0: there are no coarse ones
    MajorantGrid cells; // the coarse ones; bounds of the extinction of the channel where it is largest [1 / world unit]
    std::vector<std::uint32_t> bricks; // of each coarse cell 0, or 1 + the number of its brick; empty if there are none
    std::vector<float> brick_bounds;   // of their cells
    // Where each entry's list begins, counted from here, and where the last one ends; then the lists: media, by their
    // number in the scene.
    std::vector<std::uint32_t> overlaps;
    std::uint32_t most_overlaps = 0; // of a cell
    bool unbounded = false;          // some medium is everywhere

    glm::ivec3 dims() const { return cells.dims << bits; } // cells
    std::size_t entries() const { return cells.bounds.size() + brick_bounds.size(); }
    // A cell's entry; `cell` is counted from the first.
    std::size_t entry_of(glm::ivec3 cell) const;
    float bound(std::size_t entry) const {
        return entry < cells.bounds.size() ? cells.bounds[entry] : brick_bounds[entry - cells.bounds.size()];
    }
    std::span<const std::uint32_t> list(std::size_t entry) const {
        return std::span(overlaps).subspan(overlaps[entry], overlaps[entry + 1] - overlaps[entry]);
    }
    // Places in the lists.
    std::size_t listed() const { return overlaps.empty() ? 0 : overlaps.size() - entries() - 1; }

    glm::dvec3 low() const { return glm::dvec3(cells.origin); } // in its space
    glm::dvec3 high() const { return glm::dvec3(cells.origin + dims()); }
    double diagonal() const { return edge * glm::length(high() - low()); } // world units
    double mean_bound() const;                                             // over the box
};

// Cells over the media that have been loaded for `scene`; none where no medium has any matter. Throws InputError if
// they lie too far apart for their sizes.
Superposition superpose(const Scene& scene, std::span<const LoadedMedium> media, const Method& method);

// By entry, as walks have them: what is empty has minus its reach, in units of its own edge, if they leap. See
// empty_space.h.
std::vector<float> walked_bounds(const Superposition& whole);

} // namespace vkvol
