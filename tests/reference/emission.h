// Radiance emitted per absorption event: constant, or following a grid of temperatures or colours.
#pragma once

#include <vector>

#include "grid.h"

namespace reference {

// Planck's law seen by the CIE 1931 observer (linear between its steps of 5 nm), linear Rec.709, each channel
// at least 0; luminance 1 at `reference` kelvin.
vkvol::Rgb blackbody(double kelvin, double reference);

struct Emission {
    vkvol::Rgb constant{0.0};
    vkvol::TemperatureEmission temperature;
    Grid grid;                           // of temperatures; empty: constant alone,
    ColorGrid colors;                    // or this
    std::vector<vkvol::Rgb> blackbodies; // every `spacing` kelvin from 0 on

    static constexpr double spacing = 0.5;

    vkvol::Rgb at(const glm::dvec3& world, bool nearest_voxel) const;
};

// `file` is the density field's; null for other shapes than grids. Without a temperature grid in it nothing glows but
// `Le`.
Emission load_emission(const vkvol::Volume& volume, const vkvol::GridFile* file);

} // namespace reference
