#include "light_tree.h"

#include <algorithm>
#include <span>

#include "shared/constants.h"

namespace vkvol {

namespace {

void append(std::vector<shared::LightNode>& nodes, std::span<PlacedLight> lights) {
    shared::LightNode node{lights[0].low, lights[0].high, 0.0f, NO_LIGHT, 0};
    glm::vec3 low(lights[0].low + lights[0].high), high(low); // of twice the middles
    for (const PlacedLight& light : lights) {
        node.low = glm::min(node.low, light.low);
        node.high = glm::max(node.high, light.high);
        node.power += light.power;
        low = glm::min(low, light.low + light.high);
        high = glm::max(high, light.low + light.high);
    }
    const std::size_t at = nodes.size();
    nodes.push_back(node);
    if (lights.size() == 1) {
        nodes[at].light = lights[0].row;
        return;
    }
    // Halves along the longest axis: the depth is that of a balanced tree, whatever the lights.
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = lights.size() / 2;
    std::nth_element(lights.begin(), lights.begin() + std::ptrdiff_t(half), lights.end(),
                     [axis](const PlacedLight& a, const PlacedLight& b) {
                         const float x = a.low[axis] + a.high[axis], y = b.low[axis] + b.high[axis];
                         return x != y ? x < y : a.row < b.row; // one order with every standard library
                     });
    append(nodes, lights.first(half));
    nodes[at].right = static_cast<std::uint32_t>(nodes.size());
    append(nodes, lights.subspan(half));
}

} // namespace

std::vector<shared::LightNode> make_light_tree(std::vector<PlacedLight> lights) {
    std::vector<shared::LightNode> nodes;
    nodes.reserve(2 * lights.size() - 1);
    append(nodes, lights);
    return nodes;
}

} // namespace vkvol
