// Filling a box of index space brick by brick, in parallel, keeping only bricks that hold something.
#pragma once

#include <functional>
#include <span>

#include "field.h"

namespace vkvol {

// Inclusive on both ends.
struct IndexBox {
    glm::ivec3 min{0};
    glm::ivec3 max{0};
};

bool contains(const IndexBox& box, glm::ivec3 index);

// Fills one brick per grid for the brick at `channels[0].origin`. Called from several threads.
using FillBrick = std::function<void(std::span<Brick> channels)>;

// Visits each brick that touches `box`; samples outside of it are reset to 0; bricks of zeros are dropped.
// The order of the bricks, and so the file, does not depend on the number of threads.
void fill_bricks(const IndexBox& box, std::span<FieldGrid> grids, const FillBrick& fill);

// The usual case: one grid, one value for each index.
FieldGrid grid_of(const IndexBox& box, const std::function<float(glm::ivec3)>& value);

// Sets to 0 each sample that is not connected, face to face, to the largest connected set of active samples:
// noise tears specks off a cloud, and a speck that floats alone looks like dust on the lens.
void drop_islands(FieldGrid& grid);

} // namespace vkvol
