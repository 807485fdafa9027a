// The tree by which the kernels choose among lights that are somewhere: see shaders/lights/tree.glsl.
#pragma once

#include <numbers>
#include <vector>

#include "shared/frame.h"

namespace vkvol {

struct PlacedLight {
    glm::vec3 low, high; // of the box around it
    float power = 0.0f;  // > 0, in any unit
    float power_in_matter = 0.0f;
    std::uint32_t row = 0;
    glm::vec3 axis{0.0f, 0.0f, 1.0f}; // unit, about which it shines
    double reach = std::numbers::pi;  // radians, the most that its light is off that
};

// In depth-first order, the root first; of one light or more.
std::vector<shared::LightNode> make_light_tree(std::vector<PlacedLight> lights);

} // namespace vkvol
