// Images of more than radiance, by the names with which they are asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vkvol {

// Bits of a set of layers. What light there is by how often it was scattered; by the group of its source; by the medium
// that sends it toward the sensor; of a ray's first collision, if it has one, how far it is, where, and the albedo
// there; how much of the ray's light comes through; and the normal of the surface that the ray meets first.
enum Aovs : unsigned {
    layer_background = 1,
    layer_emission = 2,
    layer_direct = 4,
    layer_indirect = 8,
    layer_groups = 16,
    layer_media = 32,
    layer_depth = 64,
    layer_position = 128,
    layer_albedo = 256,
    layer_transmittance = 512,
    layer_alpha = 1024,
    layer_normal = 2048,
};
inline constexpr unsigned layers_of_rays = // that a sensor of flux, whose rays go everywhere, has no use for
    layer_depth | layer_position | layer_albedo | layer_transmittance | layer_alpha | layer_normal;

// In the order above.
const std::vector<std::string>& layer_names();

// "direct indirect,depth": of names between spaces or commas. `wrong`: the first that is none of them.
std::optional<unsigned> parse_layers(const std::string& text, std::string& wrong);

} // namespace vkvol
