#include "light_tree.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "shared/constants.h"

namespace vkvol {

namespace {

// Radians, by which light from flat lamps and spots may seem to leave beyond its cone, by rounding.
constexpr double spare = 2e-3;

// Sets axis, spread and reach of the node over all of these lights.
void set_cone(std::span<const PlacedLight> lights, shared::LightNode& node) {
    using std::numbers::pi;
    glm::dvec3 axis(0.0);
    double reach = 0.0;
    for (const PlacedLight& light : lights) {
        axis += glm::dvec3(light.axis);
        reach = std::max(reach, light.reach);
    }
    const double length = glm::length(axis);
    axis = length > 1e-6 ? axis / length : glm::dvec3(0.0, 0.0, 1.0);
    double spread = length > 1e-6 ? 0.0 : pi;
    for (const PlacedLight& light : lights)
        spread = std::max(spread, std::acos(std::clamp(glm::dot(axis, glm::dvec3(light.axis)), -1.0, 1.0)));
    reach += spare;
    const bool everywhere = spread + reach >= pi;
    node.axis = axis;
    node.spread = everywhere ? -1.0f : static_cast<float>(std::cos(spread));
    node.reach = everywhere ? -1.0f : static_cast<float>(std::cos(reach));
}

void append(std::vector<shared::LightNode>& nodes, std::span<PlacedLight> lights) {
    shared::LightNode node{lights[0].low, lights[0].high, 0.0f, 0.0f, NO_LIGHT, 0, {}, 0.0f, 0.0f};
    set_cone(lights, node);
    glm::vec3 low(lights[0].low + lights[0].high), high(low); // of twice the middles
    for (const PlacedLight& light : lights) {
        node.low = glm::min(node.low, light.low);
        node.high = glm::max(node.high, light.high);
        node.power += light.power;
        node.power_in_matter += light.power_in_matter;
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
