// Measured media that pbrt knows by name.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vkvol {

struct PbrtPreset {
    glm::dvec3 sigma_s, sigma_a; // [1 / mm], red, green and blue; of scattering what is reduced by (1 - g)
};

std::optional<PbrtPreset> pbrt_preset(const std::string& name);
std::vector<std::string> pbrt_preset_names();

} // namespace vkvol
