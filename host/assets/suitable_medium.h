// Coefficients that suit a grid whatever its numbers mean: densities, intensities of a scan, in voxels of any size.
#pragma once

#include <optional>

#include "density_field.h"
#include "scene.h"

namespace vkvol {

// How the numbers of a temperature grid become kelvin: scale * value + offset.
struct Kelvin {
    double scale = 1.0, offset = 0.0;
    double hottest = 0.0;
};

// Numbers of some hundreds or thousands are kelvin already. Those of a solver that counts from 0 at the air's
// temperature, up to 1 or a few, are stretched to what flames have. None where nothing glows.
std::optional<Kelvin> read_kelvin(double highest);

struct SuitableMedium {
    double depth = 0.0;   // optical depth of the medium as the picture shows it
    double sigma_t = 0.0; // per world unit at density 1
    double albedo = 1.0;
    double g = 0.0;
    std::optional<Kelvin> kelvin; // glows
    double glow = 0.0;            // multiplier of the glow, whose reference is kelvin->hottest
};

// The optical depth along the picture's rays is averaged with itself as weight, so that it is that of the bulk and not
// of its thin surroundings, and brought to `depth`; the glow to the brightness that the picture is exposed for.
// `temperature`: null without one. `density` must not be empty.
SuitableMedium suit_medium(const DensityField& density, const DensityField* temperature, const Camera& camera,
                           const Picture& picture);

} // namespace vkvol
