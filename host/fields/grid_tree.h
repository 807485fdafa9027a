// The tree of a NanoVDB grid: checked, cleaned, and flattened into the table of leaves that lookups use.
#pragma once

#include <cstddef>
#include <string>

#include "density_field.h"

namespace vkvol {

// Throws InputError for a grid of more bytes than the table of leaves can tell apart, before or after it is read.
void check_grid_size(std::size_t bytes, const std::string& place);

// Fills what of `field` follows from its bytes and type: transform, box, leaf table, cleaned values. No offset in the
// file is trusted. Throws InputError, in which `place` stands for the grid.
void read_tree(DensityField& field, const std::string& place);

// Value `n` (0..511, z fastest) of a leaf node of a GRID_... type; >= 0.
float leaf_value(int type, const std::byte* leaf, unsigned n);
glm::vec3 leaf_color(const std::byte* leaf, unsigned n); // of GRID_COLOR

float read_float(const std::byte* from);
glm::vec3 read_color(const std::byte* from);

} // namespace vkvol
