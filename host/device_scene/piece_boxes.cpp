#include "piece_boxes.h"

#include <algorithm>

#include "shared/constants.h"

namespace vkvol {

std::vector<VkAabbPositionsKHR> piece_boxes(const SurfaceTable& table, float beyond) {
    std::vector<BvhBox> boxes;
    for (std::uint32_t i = table.planes; i < table.met; ++i)
        boxes.push_back(box_of(table.primitives[i]));
    BvhBox all;
    for (const BvhBox& box : boxes)
        all.add(box);
    const glm::vec3 far = glm::max(glm::abs(all.low), glm::abs(all.high));
    // Between places no further away than these along any axis; SURFACE_SPARE is 64 * 2^-24.
    const float room = SURFACE_SPARE * (std::max({far.x, far.y, far.z}) + beyond);
    std::vector<VkAabbPositionsKHR> with_room;
    for (const BvhBox& box : boxes)
        with_room.push_back({box.low.x - room, box.low.y - room, box.low.z - room, box.high.x + room, box.high.y + room,
                             box.high.z + room});
    return with_room;
}

} // namespace vkvol
