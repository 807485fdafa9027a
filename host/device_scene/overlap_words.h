// The words that look-ups in several media read, see shaders/field/superposition.glsl: a MemberRow of each, a GridRow
// of each grid, the words of each mesh, then which cells are bricks, and which media may be where.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loaded_medium.h"
#include "shared/frame.h"
#include "superposition.h"

namespace vkvol {

struct OverlapWords {
    std::vector<std::uint32_t> words;
    shared::OverlapParams places;
    shared::GridParams grid; // of all that are grids, if they have but one
};

// `rows`: of the media, in their order.
OverlapWords overlap_words(std::span<const shared::MediumParams> rows, Media media, const Superposition& whole);

} // namespace vkvol
