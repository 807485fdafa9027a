// Boxes about pieces of surfaces, for devices that search them by units of their own.
#pragma once

#include <vector>
#include <vulkan/vulkan.h>

#include "surface_table.h"

namespace vkvol {

// One for each piece that rays meet but planes, in the table's order; render space. A ray is said to meet a piece where
// the rounded numbers of mesh.glsl do, up to 28 * 2^-24 of the distance from its origin beside the exact ray. `beyond`:
// how far from render space's origin, along an axis, rays may begin for which the boxes have room for that, and as much
// again for the device's own rounding; the pieces themselves are always within. Rays from further away, as from far off on a plane,
// may pass between two pieces that touch, by what their own numbers err.
std::vector<VkAabbPositionsKHR> piece_boxes(const SurfaceTable& table, float beyond);

} // namespace vkvol
